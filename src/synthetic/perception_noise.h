#pragma once

#include <map>
#include <string>
#include <vector>

namespace cairn {

/// The errors of networks, as numbers. Defaults are fitted to what NanoDet-Plus-m, METER and MOSAIC
/// do on 7-Scenes redkitchen, by scripts/fit_perception_noise.py; docs/perception_noise.md says
/// how, and which ones are guesses because pictures without labels do not tell. What lasts is
/// correlated over time as exp(−|Δt| / seconds). Amounts are standard deviations unless said
/// otherwise.
struct PerceptionNoise {
  /// How sure a detector is of a thing: score = logistic(z), with z = at_usual_size + per_log_size
  /// · min(0, ln(√(box area) / usual size)) + per_hidden · (1 − visible share) + truncated [if cut]
  /// + what is peculiar to the thing + what comes and goes + what changes from picture to picture.
  /// A thing whose score is below the threshold is missed. Pixels are those of a picture 640 wide.
  struct Scores {
    double threshold = 0.3;
    double at_usual_size = -0.13, per_log_size = 1.16, per_hidden = -2.06, truncated = 0.22;
    double per_thing = 0.51;
    double lasting = 0.51, seconds = 0.72;
    double flicker = 0.28;
    /// Of a class, pixels: detectors know that mugs are small and chairs are not.
    std::map<std::string, double> usual_px = {
        {"cup", 48}, {"chair", 110}, {"tv", 117}, {"couch", 150}, {"dining table", 200}};
    double usual_px_else = 60;
  } scores;

  /// Edges of boxes, each on its own, as shares of the box's width or height.
  struct Boxes {
    double lasting = 0.03, seconds = 1.5;  ///< what comes and goes: a leg of the chair is left out
    double flicker = 0.0053;               ///< what changes from picture to picture,
    double floor_px = 0.48;                ///< also of small things (in a picture 640 wide)
    double tail_share = 0.114;             ///< of flicker that is larger by tail_factor
    double tail_factor = 3.4;
    double cut_factor = 1.4;     ///< edges at the border of the picture are worse by this
    double per_score = 0.32;     ///< ln(error) falls by this when z rises by 1
    double amodal_share = 0.04;  ///< 0: the visible part is boxed, 1: the hidden part as well
  } boxes;

  /// Wrong classes: of a family that detectors confuse, or any.
  struct Classes {
    std::vector<std::vector<std::string>> families = {{"cup", "bowl", "vase", "wine glass"},
                                                      {"tv", "laptop"},
                                                      {"chair", "couch", "bench"},
                                                      {"car", "truck", "bus"},
                                                      {"book", "cell phone", "remote"}};
    std::vector<std::string> any = {"book", "remote", "chair", "bottle", "tv", "suitcase"};
    double wrong = 0.035;         ///< share of detections
    double within_family = 0.59;  ///< share of these, of things that have a family
    double seconds = 0.21;
  } classes;

  /// A second box on the same thing, as another class of its family or around a part of the thing.
  struct Duplicates {
    double share = 0.056;  ///< of detections
    double seconds = 0.1;
    double score_factor = 0.85;
  } duplicates;

  /// Boxes where nothing is, at random places.
  struct FalseAlarms {
    double per_picture = 0.79;      ///< expected number in view at one time
    double seconds = 0.06;          ///< for which one stays, on average
    double score_above = 0.072;     ///< mean of score − threshold, exponential
    double size_px = 68;            ///< median of √(box area), in a picture 640 wide
    double size_log_spread = 0.52;  ///< of ln(√area)
    std::vector<std::string> classes = {"bottle",     "cup",    "chair",  "sink",
                                        "cell phone", "remote", "laptop", "handbag"};
  } false_alarms;

  /// Depth from one picture: ln(depth said) = ln(scale) + sharp · ln(depth blurred a little) +
  /// (1 − sharp) · ln(depth smeared widely) + a smooth field. Networks know less about steps than
  /// about the room.
  struct Depth {
    double scale = 1.62;         ///< median over pictures of said / true
    double scale_spread = 0.17;  ///< of ln(scale of a picture)
    double scale_seconds = 0.76;
    double sharp = 0.3;           ///< share of a step's height that is there
    double blur = 0.022;          ///< sigma of a step's edge, share of the picture's width
    double smear = 0.19;          ///< sigma of the rest, share of the picture's width
    double local = 0.154;         ///< of the smooth field
    double local_length = 0.257;  ///< its correlation length (1/e), share of the picture's width
    double local_seconds = 1.25;
  } depth;

  /// Normals: turned about axes across them, smoothly over the picture.
  struct Normals {
    double angle_deg = 21.5;  ///< about each of two axes
    double length = 0.178;    ///< correlation length (1/e), share of the picture's width
    double seconds = 1.5;
  } normals;

  /// Borders of masks: share of √(mask area) by which they are displaced in and out.
  struct Masks {
    double ragged = 0.0125;
  } masks;

  /// Planes as a detector gives them, after their depth was brought to the map's scale.
  struct Planes {
    double angle_deg = 13.4;  ///< about each of two axes across the normal
    double offset = 0.147;    ///< of ln(distance to the plane, along the ray to its middle)
    double seconds = 1.5;     ///< of both
    double missed = 0.18;     ///< share of pictures, of a plane that fills a tenth of them
    double min_share = 0.01;  ///< of the picture; smaller planes are missed
    double wrong_label = 0.15;
    double label_seconds = 0.3;
  } planes;

  /// No errors: every thing is detected, with a score of 1.
  static PerceptionNoise none();
};

}  // namespace cairn
