#include "slicing/box_tree.h"

#include "core/parallel.h"
#include "slicing/lookahead.h"
#include "slicing/tight_box.h"
#include "slicing/volume_rule.h"

#include <algorithm>
#include <utility>

namespace cagewright {
namespace {

/// No cut leaves fewer slices than this on either side, whatever the box's length (thinner parts
/// would be crumbs) ...
constexpr int least_margin = 3;
/// ... nor less than this part of its length: a sliver box helps nobody.
constexpr double margin_fraction = 0.05;

/// A cut that saves less than this fraction of the box's volume may miss the one that opens a hole
/// or a bend only together with the next: then it pays to look ahead.
constexpr double clear_gain = 0.05;

/// A leaf leaves the frame it was cut in when a box in another has less than this share of the
/// volume: neighbours in the same frame join and unite with fewer slivers.
constexpr double worth_turning = 0.95;

/// What a cut would make of a box.
struct Candidate {
  Cut cut;
  std::vector<std::vector<std::uint32_t>> parts;
  std::vector<OrientedBox> boxes;
  double volume = 0;
};

class TreeBuilder {
public:
  TreeBuilder(const VoxelGrid& grid, const SlicingOptions& options, const Progress& progress)
      : grid_(grid), options_(options),
        progress_(progress), owners_{
                                 std::vector<std::uint32_t>(grid.kinds.size(), VoxelOwners::none),
                                 std::vector<std::uint32_t>(grid.kinds.size(), 0)} {}

  Result<BoxTree> build() {
    if (!add_root()) {
      return Error{ErrorCode::unfit_model, "the model occupies no voxel"};
    }
    std::vector<int> fresh = {0};
    while (!fresh.empty()) {
      progress_(share_done(), "cutting boxes");
      examine(fresh);
      if (progress_.cancelled()) {
        return Error::cancelled();
      }
      fresh = cut_next();
    }
    if (options_.rule == SlicingRule::volume) {
      tighten_leaves();
    }
    if (progress_.cancelled()) {
      return Error::cancelled();
    }
    return std::move(tree_);
  }

private:
  bool add_root() {
    BoxNode root;
    for (std::size_t v = 0; v < grid_.kinds.size(); ++v) {
      if (grid_.occupied(v)) {
        root.voxels.push_back(static_cast<std::uint32_t>(v));
      }
    }
    if (root.voxels.empty()) {
      return false;
    }
    root.box = tight_box(grid_, root.voxels, fit(), grid_.axes, padding());
    owners_.assign(root.voxels, 0);
    tree_.nodes.push_back(std::move(root));
    candidates_.emplace_back();
    return true;
  }

  [[nodiscard]] BoxFit fit() const {
    return options_.rule == SlicingRule::volume ? BoxFit::aligned : BoxFit::pca;
  }
  [[nodiscard]] double padding() const { return options_.padding * grid_.size; }

  [[nodiscard]] double share_done() const {
    return options_.depth > 0 ? static_cast<double>(tree_.nodes.back().depth) / options_.depth : 1;
  }

  // A level of the tree may take a long time: every box and every plane asks first whether to stop.
  // What is left out then does not matter, since build() fails.

  /// Finds the f and the best cut of each new node. Nodes write only their own entries.
  void examine(const std::vector<int>& fresh) {
    each_unless_cancelled(fresh.size(), [&](std::size_t n) {
      const auto at = static_cast<std::size_t>(fresh[n]);
      measure(at);
      candidates_[at] = best_cut(at, tree_.nodes[at].stop);
    });
  }

  void measure(std::size_t at) {
    BoxNode& node = tree_.nodes[at];
    each_unless_cancelled(3, [&](std::size_t axis) {
      node.sections[axis] = cross_section(grid_, owners_, static_cast<std::uint32_t>(at), node.box,
                                          static_cast<int>(axis), options_.cross_section);
    });
    node.prismatic_ratio =
        prismatic_ratio(node.sections[0], static_cast<std::size_t>(margin_of(node)));
    node.cube_ratio = cube_ratio(node.box);
  }

  /// A box that is not cut again need not lie in the frame that was best for cutting.
  void tighten_leaves() {
    const std::vector<int> leaves = tree_.cover();
    each_unless_cancelled(leaves.size(), [&](std::size_t n) {
      const auto at = static_cast<std::size_t>(leaves[n]);
      BoxNode& leaf = tree_.nodes[at];
      const OrientedBox smallest =
          tight_box(grid_, leaf.voxels, BoxFit::smallest, leaf.box.axes, padding());
      if (smallest.volume() < worth_turning * leaf.box.volume()) {
        leaf.box = smallest;
        measure(at);
      }
    });
  }

  [[nodiscard]] int margin_of(const BoxNode& node) const {
    const double slices = 2 * node.box.half[0] / grid_.size;
    return std::max(least_margin, static_cast<int>(margin_fraction * slices));
  }

  std::optional<Candidate> best_cut(std::size_t at, StopReason& stop) const {
    const BoxNode& node = tree_.nodes[at];
    if (node.depth >= options_.depth) {
      stop = StopReason::depth;
      return std::nullopt;
    }
    if (node.prismatic_ratio > options_.eta && node.cube_ratio > options_.zeta) {
      stop = StopReason::prismatic;
      return std::nullopt;
    }
    return options_.rule == SlicingRule::volume ? best_by_volume(at, stop) : best_by_jump(at, stop);
  }

  std::optional<Candidate> best_by_volume(std::size_t at, StopReason& stop) const {
    const BoxNode& node = tree_.nodes[at];
    const std::vector<CutPlane> planes = volume_cuts(
        grid_, owners_, static_cast<std::uint32_t>(at), node.voxels, node.box,
        {.split_parts = options_.split_parts, .margin = margin_of(node), .padding = padding()});
    const std::vector<double> at_once(planes.size(), 1.0);
    std::optional<Prospect> best = most_promising(at, planes, at_once);
    if (node.depth + 1 < options_.depth && (!best || best->gain < clear_gain)) {
      best = look_ahead(at, planes);
    }
    stop = !best ? StopReason::too_small : StopReason::cut;
    if (best && best->gain < options_.min_gain) {
      stop = StopReason::no_gain;
      return std::nullopt;
    }
    return best ? std::optional<Candidate>(std::move(best->candidate)) : std::nullopt;
  }

  struct Prospect {
    Candidate candidate;
    double gain = 0; ///< volume saved by this cut, or by this and the next: a fraction of the box's
  };

  /// Of the planes that cut something off, the one that leaves the least volume.
  /// \param share_left for each plane, what later cuts leave of the volume of its parts' boxes
  [[nodiscard]] std::optional<Prospect>
  most_promising(std::size_t at, const std::vector<CutPlane>& planes,
                 const std::vector<double>& share_left) const {
    std::vector<std::optional<Candidate>> tried(planes.size());
    each_unless_cancelled(planes.size(), [&](std::size_t p) { tried[p] = carve(at, planes[p]); });
    std::optional<Prospect> best;
    for (std::size_t p = 0; p < tried.size(); ++p) {
      if (!tried[p]) {
        continue;
      }
      const double gain = 1 - share_left[p] * tried[p]->volume / tree_.nodes[at].box.volume();
      if (!best || gain > best->gain) {
        best = Prospect{std::move(*tried[p]), gain};
      }
    }
    return best;
  }

  /// The best of these and of evenly spaced planes, judged by what the cut after the next leaves.
  [[nodiscard]] std::optional<Prospect> look_ahead(std::size_t at,
                                                   std::vector<CutPlane> planes) const {
    const BoxNode& node = tree_.nodes[at];
    const Lookahead lookahead(grid_, node.voxels, node.box, options_.split_parts, padding());
    for (const CutPlane& plane : lookahead.evenly_spaced_planes(margin_of(node) * grid_.size)) {
      planes.push_back(plane);
    }
    std::vector<double> share_left(planes.size());
    each_unless_cancelled(planes.size(),
                          [&](std::size_t p) { share_left[p] = lookahead.share_left(planes[p]); });
    return most_promising(at, planes, share_left);
  }

  std::optional<Candidate> best_by_jump(std::size_t at, StopReason& stop) const {
    const BoxNode& node = tree_.nodes[at];
    const std::vector<PublishedCut> cuts = published_cuts(
        node.box, node.sections,
        {.min_jump = options_.min_jump, .margin = margin_of(node), .no_jump = options_.no_jump});
    for (const PublishedCut& cut : cuts) {
      if (std::optional<Candidate> candidate = carve(at, cut.plane)) {
        candidate->cut.jump = cut.jump;
        candidate->cut.middle = cut.middle;
        stop = StopReason::cut;
        return candidate;
      }
    }
    stop = cuts.empty() && options_.no_jump == NoJump::skip ? StopReason::no_jump
                                                            : StopReason::too_small;
    return std::nullopt;
  }

  /// The parts and boxes that a plane makes of a node; nothing when it cuts nothing off.
  [[nodiscard]] std::optional<Candidate> carve(std::size_t at, const CutPlane& plane) const {
    const BoxNode& node = tree_.nodes[at];
    Candidate candidate;
    candidate.parts = partition(grid_, owners_, static_cast<std::uint32_t>(at), node.voxels,
                                node.box, plane, options_.split_parts);
    if (candidate.parts.size() < 2) {
      return std::nullopt;
    }
    for (const std::vector<std::uint32_t>& part : candidate.parts) {
      candidate.boxes.push_back(tight_box(grid_, part, fit(), node.box.axes, padding()));
      candidate.volume += candidate.boxes.back().volume();
    }
    const Vec3 normal = node.box.axes.col(plane.axis);
    candidate.cut.plane = plane;
    candidate.cut.normal = normal;
    candidate.cut.point = node.box.center + plane.offset * normal;
    candidate.cut.gain = 1 - candidate.volume / node.box.volume();
    return candidate;
  }

  /// Carries out the cuts that are due: all of them, or while the number of boxes is limited the
  /// one that saves the most volume.
  std::vector<int> cut_next() {
    std::vector<std::size_t> due;
    for (std::size_t at = 0; at < candidates_.size(); ++at) {
      if (candidates_[at]) {
        due.push_back(at);
      }
    }
    std::vector<int> fresh;
    if (options_.max_boxes <= 0) {
      for (const std::size_t at : due) {
        perform(at, fresh);
      }
      return fresh;
    }
    std::stable_sort(due.begin(), due.end(),
                     [&](std::size_t a, std::size_t b) { return saving(a) > saving(b); });
    for (const std::size_t at : due) {
      const auto boxes = static_cast<int>(tree_.cover().size() + candidates_[at]->parts.size()) - 1;
      if (boxes <= options_.max_boxes) {
        perform(at, fresh);
        return fresh;
      }
      tree_.nodes[at].stop = StopReason::max_boxes;
      candidates_[at].reset();
    }
    return fresh;
  }

  [[nodiscard]] double saving(std::size_t at) const {
    return candidates_[at]->cut.gain * tree_.nodes[at].box.volume();
  }

  void perform(std::size_t at, std::vector<int>& fresh) {
    Candidate candidate = std::move(*candidates_[at]);
    candidates_[at].reset();
    tree_.nodes[at].cut = candidate.cut;
    tree_.nodes[at].stop = StopReason::cut;
    for (std::size_t p = 0; p < candidate.parts.size(); ++p) {
      const auto index = static_cast<int>(tree_.nodes.size());
      BoxNode child;
      child.parent = static_cast<int>(at);
      child.depth = tree_.nodes[at].depth + 1;
      child.box = candidate.boxes[p];
      child.voxels = std::move(candidate.parts[p]);
      owners_.assign(child.voxels, static_cast<std::uint32_t>(index));
      tree_.nodes[at].children.push_back(index);
      tree_.nodes.push_back(std::move(child));
      candidates_.emplace_back();
      fresh.push_back(index);
    }
  }

  template <class Body> void each_unless_cancelled(std::size_t count, const Body& body) const {
    parallel_for(0, count, 1, [&](std::size_t i) {
      if (!progress_.cancelled()) {
        body(i);
      }
    });
  }

  const VoxelGrid& grid_;
  const SlicingOptions& options_;
  const Progress& progress_;
  VoxelOwners owners_;
  BoxTree tree_;
  std::vector<std::optional<Candidate>> candidates_; // for each node the cut it waits for
};

} // namespace

std::string_view name_of(StopReason reason) {
  switch (reason) {
  case StopReason::cut:
    return "cut";
  case StopReason::depth:
    return "depth";
  case StopReason::too_small:
    return "too_small";
  case StopReason::prismatic:
    return "prismatic";
  case StopReason::no_jump:
    return "no_jump";
  case StopReason::no_gain:
    return "no_gain";
  case StopReason::max_boxes:
    return "max_boxes";
  }
  return "unknown";
}

std::string_view name_of(SlicingRule rule) {
  return rule == SlicingRule::volume ? "volume" : "published";
}

std::vector<int> BoxTree::cover(int depth) const {
  std::vector<int> nodes_at;
  for (std::size_t at = 0; at < nodes.size(); ++at) {
    const BoxNode& node = nodes[at];
    if (depth < 0 ? node.children.empty()
                  : node.depth == depth || (node.depth < depth && node.children.empty())) {
      nodes_at.push_back(static_cast<int>(at));
    }
  }
  return nodes_at;
}

Result<BoxTree> build_box_tree(const VoxelGrid& grid, const SlicingOptions& options,
                               const Progress& progress) {
  if (options.depth < 0 || options.depth > 20) {
    return Error{ErrorCode::invalid_option, "depth must be from 0 to 20"};
  }
  if (!(options.eta > 0) || !(options.zeta > 0)) {
    return Error{ErrorCode::invalid_option, "eta and zeta must be above 0"};
  }
  return TreeBuilder(grid, options, progress).build();
}

} // namespace cagewright
