#include "app/commands/live_check.h"

namespace cagewright::app {

void LiveCheck::begin() {
  stopped_ = false;
  watch_.reset();
  if (!document_.has_cage() || document_.mode() != Mode::refine) {
    return;
  }
  if (model_ != document_.caged().shared_model()) {
    model_ = document_.caged().shared_model();
    watched_ = nullptr;
    if (model_) {
      // The hierarchy is the model's own, and lives as long as it.
      watched_ = std::make_shared<const WatchedModel>(
          model_->watched, std::shared_ptr<const TriangleBvh>(model_, &model_->bvh));
    }
  }
  watch_.emplace(document_.cage(), watched_);
}

std::vector<Vec3> LiveCheck::move(std::span<const Index> vertices,
                                  std::span<const Vec3> positions) {
  std::vector<Vec3> to(positions.begin(), positions.end());
  if (!watch_) {
    return to;
  }
  if (document_.tools().stop_at_contact) {
    stopped_ = watch_->advance(vertices, positions) < 1;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      to[i] = watch_->cage().positions[vertices[i]];
    }
  } else {
    stopped_ = false;
    watch_->move(vertices, positions);
  }
  document_.set_offending_faces(watch_->bad_faces());
  return to;
}

void LiveCheck::end() {
  watch_.reset();
}

} // namespace cagewright::app
