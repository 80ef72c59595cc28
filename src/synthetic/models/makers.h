#pragma once

#include "cairn/synthetic/model.h"
#include "cairn/synthetic/models/dice.h"

// One function a class; the dice decide on sizes, proportions, kinds, colours and prints.

namespace cairn {

// tableware.cpp
Model make_cup(Dice& dice);
Model make_bottle(Dice& dice);
Model make_bowl(Dice& dice);
Model make_vase(Dice& dice);
Model make_wine_glass(Dice& dice);

// office.cpp, computers.cpp
Model make_book(Dice& dice);
Model make_keyboard(Dice& dice);
Model make_mouse(Dice& dice);
Model make_tv(Dice& dice);
Model make_laptop(Dice& dice);
Model make_cell_phone(Dice& dice);

// chairs.cpp, tables.cpp, furniture.cpp
Model make_chair(Dice& dice);
Model make_dining_table(Dice& dice);
Model make_couch(Dice& dice);
Model make_bed(Dice& dice);
Model make_bench(Dice& dice);
Model make_shelf(Dice& dice);
Model make_cabinet(Dice& dice);

// household.cpp, kitchen.cpp, plants.cpp
Model make_clock(Dice& dice);
Model make_suitcase(Dice& dice);
Model make_backpack(Dice& dice);
Model make_sports_ball(Dice& dice);
Model make_refrigerator(Dice& dice);
Model make_microwave(Dice& dice);
Model make_apple(Dice& dice);
Model make_orange(Dice& dice);
Model make_banana(Dice& dice);
Model make_remote(Dice& dice);
Model make_potted_plant(Dice& dice);
Model make_tree(Dice& dice);

// building.cpp
Model make_door(Dice& dice);
Model make_window(Dice& dice);
Model make_poster(Dice& dice);
Model make_lamp(Dice& dice);
Model make_floor_lamp(Dice& dice);

// cars.cpp, trucks.cpp, street.cpp
Model make_car(Dice& dice);
Model make_truck(Dice& dice);
Model make_bus(Dice& dice);
Model make_traffic_light(Dice& dice);
Model make_stop_sign(Dice& dice);
Model make_fire_hydrant(Dice& dice);

}  // namespace cairn
