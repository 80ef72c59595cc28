#include "cairn/features/orb_extractor.h"

namespace cairn {

struct OrbExtractor::Buffers {};

OrbExtractor::OrbExtractor(const OrbOptions& options)
    : options_(options), buffers_(std::make_unique<Buffers>()) {}
OrbExtractor::~OrbExtractor() = default;
void OrbExtractor::extract(const cv::Mat&, Features& features) { features = {}; }

}  // namespace cairn
