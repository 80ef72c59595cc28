# A room is one folder of src/ built as one library. It sees the headers of the rooms it links and
# of no other: each room is reached through an include folder of its own, in the build tree, that
# holds one link, cairn/<room>. An include that goes against the architecture does not compile.

add_library(cairn_settings INTERFACE)
target_compile_options(cairn_settings INTERFACE -Wall -Wextra -Werror -Wno-psabi)
if(CAIRN_NATIVE)
  target_compile_options(cairn_settings INTERFACE -march=native)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(cairn_settings INTERFACE -march=x86-64-v2)
endif()
if(CAIRN_SANITIZE)
  # Left out are checks at each access that double the time of Eigen's code, and whose faults the
  # address sanitizer or the processor report as well.
  target_compile_options(cairn_settings INTERFACE -fsanitize=${CAIRN_SANITIZE}
                         -fno-sanitize=null,alignment,object-size,vptr -fno-omit-frame-pointer)
  target_link_options(cairn_settings INTERFACE -fsanitize=${CAIRN_SANITIZE})
endif()

set(CAIRN_PRECOMPILED <algorithm> <array> <cmath> <cstdint> <functional> <map> <memory> <optional>
    <span> <string> <vector> <Eigen/Core> <Eigen/Geometry> <opencv2/core.hpp>)

# cairn_room(NAME [ROOMS room...] [LIBRARIES target...])
function(cairn_room NAME)
  cmake_parse_arguments(ROOM "" "" "ROOMS;LIBRARIES" ${ARGN})
  file(GLOB SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${NAME}/*.cpp
       ${CMAKE_CURRENT_SOURCE_DIR}/${NAME}/*/*.cpp)
  add_library(cairn_${NAME} STATIC ${SOURCES})
  add_library(cairn::${NAME} ALIAS cairn_${NAME})
  set(INCLUDE_DIR ${PROJECT_BINARY_DIR}/rooms/${NAME})
  file(MAKE_DIRECTORY ${INCLUDE_DIR}/cairn)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${NAME} ${INCLUDE_DIR}/cairn/${NAME} SYMBOLIC)
  target_include_directories(cairn_${NAME} PUBLIC $<BUILD_INTERFACE:${INCLUDE_DIR}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM ROOM_ROOMS PREPEND cairn_)
  target_link_libraries(cairn_${NAME} PUBLIC ${ROOM_ROOMS} ${ROOM_LIBRARIES}
                        PRIVATE $<BUILD_INTERFACE:cairn_settings>)
  set_target_properties(cairn_${NAME} PROPERTIES EXPORT_NAME ${NAME})
  install(TARGETS cairn_${NAME} EXPORT cairn)
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${NAME}/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cairn/${NAME} FILES_MATCHING PATTERN "*.h")
  if(NAME STREQUAL "geometry")
    target_precompile_headers(cairn_${NAME} PRIVATE ${CAIRN_PRECOMPILED})
  else()
    target_precompile_headers(cairn_${NAME} REUSE_FROM cairn_geometry)
  endif()
endfunction()
