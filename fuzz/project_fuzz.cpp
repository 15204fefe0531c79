// Any bytes as a project of the desktop application: a project whose numbers are within their
// ranges and fit together, or one line of error. What is read is written and read again.
#include "app/document/project_file.h"
#include "app/document/time_line.h"
#include "require.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace {

using namespace cagewright;
using fuzz::require;
using fuzz::require_one_line;

bool is_within(const Vec3& p) {
  return p.cwiseAbs().maxCoeff() <= 1e50;
}

void check(const app::Project& project) {
  const app::State& state = project.state;
  for (const std::string& note : project.notes) {
    require_one_line(note);
  }
  const auto within = [](const auto& painted, float least) {
    return !painted || std::ranges::all_of(*painted, [&](float s) { return s >= least && s <= 1; });
  };
  require(within(state.density, -1) && within(state.mix, 0), "what is painted is within its range");
  if (!state.rest) {
    require(state.poses.empty() && state.time_line.keys.empty(), "poses are of a cage");
    return;
  }
  const std::size_t count = state.rest->positions.size();
  require(state.cage && state.cage->size() == count, "the cage is posed");
  require(std::ranges::all_of(*state.cage, is_within), "positions are within their range");
  require(std::ranges::all_of(state.rest->corners(), [&](Index v) { return v < count; }),
          "corners are vertices");
  for (const app::Pose& pose : state.poses) {
    require(pose.positions->size() == count, "a pose has the cage's vertices");
  }
  const app::TimeLine& line = state.time_line;
  require(line.first < line.last && line.frames_per_second >= 1, "the time line has frames");
  for (const double frame : {line.first - 1.0, line.first + 0.5, 1.0 * line.last}) {
    const std::size_t vertices = cage_at(line, frame).size();
    require(vertices == (line.keys.empty() ? 0 : count), "the cage between keyframes");
    require(pose_shares_at(line, frame, state.poses.size()).size() == state.poses.size(),
            "a share for each pose");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path path = "/tmp/fuzz.cagewright";
  const auto bytes =
      QByteArray::fromRawData(reinterpret_cast<const char*>(data), static_cast<qsizetype>(size));
  const Result<app::Project> project = app::parse_project(bytes, path);
  if (!project) {
    require_one_line(project.error().message);
    return 0;
  }
  check(*project);
  const QByteArray written = app::format_project(*project, path);
  const Result<app::Project> again = app::parse_project(written, path);
  require(again.has_value(), "what is written can be read");
  require(again->notes.empty(), "what is written is within its ranges");
  require(app::format_project(*again, path) == written, "what is written reads back as the same");
  return 0;
}
