#include "joints.h"

#include "io/source.h"
#include <cagewright/io/read_joints.h>

#include <algorithm>

namespace cagewright::cli {

CLI::Option* add_joints_option(CLI::App& command, std::string& file, const std::string& purpose) {
  return command
      .add_option("--joints", file,
                  purpose + ": a text file with a line 'x y z' for each joint, or 'x y z PARENT' "
                            "of a skeleton (joints are counted from 1, 0: no parent), or a rigged "
                            "model (glTF, GLB)")
      ->option_text("FILE");
}

Result<std::vector<LimbJoint>> limb_joints(const std::string& file, Pose pose) {
  std::vector<LimbJoint> limbs;
  if (file.empty()) {
    return limbs;
  }
  const Result<Skeleton> skeleton = read_joints(file, pose);
  if (!skeleton) {
    return skeleton.error();
  }
  const std::vector<Joint>& joints = skeleton->joints;
  const bool are_points =
      std::ranges::all_of(joints, [](const Joint& joint) { return joint.parent == Joint::none; });
  for (Index j = 0; j < joints.size(); ++j) {
    LimbJoint limb{joints[j].position, Vec3::Zero()};
    int children = 0;
    for (const Joint& child : joints) {
      const Vec3 bone = child.position - limb.position;
      if (child.parent == j && bone.norm() > 0) {
        limb.along += bone.normalized();
        ++children;
      }
    }
    if (are_points || (children > 0 && joints[j].parent != Joint::none)) {
      limbs.push_back(limb);
    }
  }
  if (limbs.empty()) {
    return Error{ErrorCode::invalid_option,
                 one_line(file) + ": no joint stands between a parent and a child; give points "
                                  "without parents, or a longer skeleton"};
  }
  return limbs;
}

} // namespace cagewright::cli
