#include <cagewright/io/read_joints.h>

#include "io/read_file.h"
#include "io/source.h"
#include "io/text_cursor.h"
#include <cagewright/io/mesh_format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace cagewright {
namespace {

constexpr const char* remedy =
    "; write a line for each joint: x y z, and the number of its parent if it has one";

class JointsReader {
public:
  explicit JointsReader(const Source& source) : source_(source), cursor_(source) {}

  Result<Skeleton> read() {
    std::size_t greatest = 0;
    for (; cursor_.next_word_of_file(); cursor_.next_line()) {
      const Status line = read_line(greatest);
      if (!line) {
        return line.error();
      }
    }
    if (skeleton_.joints.empty()) {
      return source_.error("has no joints" + std::string(remedy));
    }
    if (greatest > skeleton_.joints.size()) {
      return source_.error("names joint " + std::to_string(greatest) + " as a parent, but has " +
                           std::to_string(skeleton_.joints.size()) + " joints" + remedy);
    }
    return std::move(skeleton_);
  }

private:
  Status read_line(std::size_t& greatest) {
    Joint joint;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const std::optional<double> value = number();
      if (!value || !std::isfinite(*value)) {
        return cursor_.error("is no joint" + std::string(remedy));
      }
      joint.position[a] = *value;
    }
    if (!at_end()) {
      const std::optional<double> parent = number();
      constexpr double most = 1e6;
      if (!parent || *parent < 0 || *parent > most || *parent != std::floor(*parent)) {
        return cursor_.error("does not name a parent by a number from 0 on" + std::string(remedy));
      }
      const auto above = static_cast<std::size_t>(*parent);
      greatest = std::max(greatest, above);
      joint.parent = above > 0 ? static_cast<Index>(above - 1) : Joint::none;
    }
    if (!at_end()) {
      return cursor_.error("has more than four numbers" + std::string(remedy));
    }
    joint.name = "joint " + std::to_string(skeleton_.joints.size() + 1);
    skeleton_.joints.push_back(std::move(joint));
    return success();
  }

  std::optional<double> number() {
    cursor_.skip_blanks();
    return cursor_.any_number();
  }

  bool at_end() {
    cursor_.skip_blanks();
    return cursor_.at_line_end();
  }

  const Source& source_;
  TextCursor cursor_;
  Skeleton skeleton_;
};

} // namespace

Result<Skeleton> read_joints(const std::filesystem::path& path, Pose pose) {
  const Result<FileBytes> file = read_file(path);
  if (!file) {
    return file.error();
  }
  const std::string name = path.string();
  const Source source{name, file->view()};
  const std::optional<MeshFormat> format = format_of_content(source.bytes);
  if (format != MeshFormat::gltf) {
    return JointsReader(source).read();
  }
  Result<Skeleton> skeleton = read_skeleton(path, pose);
  if (skeleton && skeleton->joints.empty()) {
    return source.error("has no joints; give a rigged model, or a text file of points",
                        ErrorCode::unsupported);
  }
  return skeleton;
}

} // namespace cagewright
