/// \file
/// The cage is judged at every step of a drag.
#pragma once

#include "app/document/document.h"
#include "app/edit/cage_watch.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace cagewright::app {

/// While the cage is refined, keeps Document::offending_faces() true from one movement of the mouse
/// to the next, and holds the cage back where it would become invalid. In deform mode it does
/// nothing: a pose may be anything.
class LiveCheck {
public:
  explicit LiveCheck(Document& document) : document_(document) {}

  void begin();
  /// \returns where the vertices may go: `positions`, or short of them when the tools say to stop
  /// at contact
  std::vector<Vec3> move(std::span<const Index> vertices, std::span<const Vec3> positions);
  /// Whether the last move() stopped short.
  [[nodiscard]] bool stopped() const { return stopped_; }
  void end();

private:
  Document& document_;
  std::shared_ptr<const Model> model_; // that watched_ was made for
  std::shared_ptr<const WatchedModel> watched_;
  std::optional<CageWatch> watch_;
  bool stopped_ = false;
};

} // namespace cagewright::app
