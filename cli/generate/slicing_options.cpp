#include "generate/arguments.h"

#include <map>
#include <string>

namespace cagewright::cli {

void add_slicing_options(CLI::App& command, SlicingOptions& slicing) {
  const char* group = "Slicing";
  command.add_option("--depth", slicing.depth, "How often a part of the model may be cut in two")
      ->check(CLI::Range(0, 20))
      ->group(group);
  command
      .add_option(
          "--boxes", slicing.max_boxes,
          "Use at most so many boxes, cutting where it pays most; 0: as many as --depth gives")
      ->check(CLI::Range(0, 100000))
      ->group(group);
  command
      .add_option("--slicing", slicing.rule,
                  "volume: cut where the boxes of the parts get smallest; "
                  "published: at the greatest jump of the cross-section")
      ->transform(CLI::CheckedTransformer(std::map<std::string, SlicingRule>{
          {"volume", SlicingRule::volume}, {"published", SlicingRule::published}}))
      ->default_str("volume")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--split", [&slicing](const std::string& how) { slicing.split_parts = how == "parts"; },
          "parts: each connected part of a half gets a box; binary: each half gets one")
      ->check(CLI::IsMember({"parts", "binary"}))
      ->default_str("parts")
      ->group(group);
  command
      .add_option(
          "--no-jump", slicing.no_jump,
          "With --slicing published, when no axis has a clear jump: middle cuts the longest "
          "edge in the middle, skip leaves the box whole")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, NoJump>{{"middle", NoJump::middle}, {"skip", NoJump::skip}}))
      ->default_str("middle")
      ->group(group);
  command
      .add_option("--min-jump", slicing.min_jump,
                  "With --slicing published: least clear jump, as a fraction of the greatest "
                  "cross-section")
      ->check(CLI::Range(0.0, 1.0))
      ->group(group);
  command
      .add_option("--min-gain", slicing.min_gain,
                  "With --slicing volume: least fraction of a box's volume that a cut must save")
      ->check(CLI::Range(0.0, 1.0))
      ->group(group);
  command
      .add_option("--eta", slicing.eta,
                  "Leave a box whole when (least / greatest cross-section) is above this, and "
                  "--zeta holds too; a value above 1 switches the test off")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command
      .add_option("--zeta", slicing.zeta,
                  "Leave a box whole when (shortest / longest edge) is above this, and --eta "
                  "holds too; a value above 1 switches the test off")
      ->check(CLI::PositiveNumber)
      ->group(group);
}

} // namespace cagewright::cli
