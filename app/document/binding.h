/// \file
/// A model bound to a cage, as the document keeps it.
#pragma once

#include <cagewright/deform/deformer.h>

#include <utility>

namespace cagewright::app {

/// Keeps a Deformer. The document only holds on to it; DeformLoop alone uses it.
class Binding {
public:
  explicit Binding(Deformer deformer) : deformer_(std::move(deformer)) {}
  [[nodiscard]] Deformer& deformer() const { return deformer_; }

private:
  mutable Deformer deformer_;
};

} // namespace cagewright::app
