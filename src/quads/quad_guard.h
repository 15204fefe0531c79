/// \file
/// The invariant: valid under every choice of diagonals, before and after every step.
#pragma once

#include "improve/guard.h"
#include "quads/quad_cage.h"
#include "quads/quad_shape.h"

#include <tbb/concurrent_unordered_map.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cagewright {

/// For tables by indices.
inline std::size_t hash_of_indices(std::span<const Index> indices) {
  std::uint64_t h = 0;
  for (const Index i : indices) {
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;
    h = (h ^ i) * golden;
    h ^= h >> 29U;
  }
  return static_cast<std::size_t>(h);
}

/// Which triangles between the vertices of a cage keep clear of the model, as far as it has been
/// asked: good for as long as no vertex moves. Any number of threads may ask.
class KnownClear {
public:
  [[nodiscard]] std::optional<bool> find(const Triangle& sorted) const;
  void add(const Triangle& sorted, bool is_clear);

private:
  struct Hash {
    std::size_t operator()(const Triangle& t) const { return hash_of_indices(t); }
  };
  tbb::concurrent_unordered_map<Triangle, bool, Hash> known_;
};

/// Decides whether faces may stand in a cage. Every part of every quad counts as a face of its own,
/// and the tetrahedron between a quad's two cuttings must not hold a part of the model.
class QuadGuard {
public:
  /// \param clearance least distance to the model, in its units
  QuadGuard(const ModelSurface& model, double clearance, const QuadLimits& limits)
      : model_(&model), clearance_(clearance), limits_(limits) {}

  /// The same guard, which remembers what keeps clear of the model. No vertex may move meanwhile,
  /// and what is known must live as long as it.
  [[nodiscard]] QuadGuard while_still(KnownClear& known) const {
    QuadGuard guard = *this;
    guard.known_ = &known;
    return guard;
  }

  [[nodiscard]] const ModelSurface& model() const { return *model_; }
  [[nodiscard]] double clearance() const { return clearance_; }
  [[nodiscard]] const QuadLimits& limits() const { return limits_; }

  /// True when the triangle has an area, keeps clear of the model and crosses none of these faces
  /// of the cage; whether they fit together otherwise is not asked.
  [[nodiscard]] bool is_free(const QuadCage& cage, std::span<const Index> faces,
                             const Triangle& part) const;

  /// True when some part of the model is inside the tetrahedron between the quad's two cuttings.
  [[nodiscard]] bool encloses_a_part(std::span<const Vec3> positions, const CageFace& quad) const;

  /// True when no part of the face comes nearer to the model than the clearance.
  [[nodiscard]] bool is_clear(std::span<const Vec3> positions, const CageFace& face) const;

  /// True when the face crosses another of the cage, or one of `with`, or meets one along a
  /// diagonal, or has no area. The faces `without` and the face `itself` are not looked at.
  [[nodiscard]] bool is_crossed(const QuadCage& cage, std::span<const Vec3> positions,
                                std::span<const Box3> boxes, const CageFace& face, Index itself,
                                std::span<const Index> without = {},
                                std::span<const CageFace> with = {}) const;

  /// True when the face crosses one of these.
  [[nodiscard]] static bool is_crossed_by(std::span<const Vec3> positions, const CageFace& face,
                                          std::span<const CageFace> others);

  /// True when the face may stand in the cage without the faces `without`, beside `with`. A quad
  /// that would be valid along one diagonal only is made tentative if that is allowed.
  [[nodiscard]] bool fits(const QuadCage& cage, std::span<const Box3> boxes,
                          std::span<const Index> without, std::span<const CageFace> with,
                          CageFace& face, bool tentative) const;

  /// True when some part of the model lies between the old faces and the new ones, which have the
  /// same border.
  [[nodiscard]] bool loses_a_part(const QuadCage& cage, std::span<const Index> removed,
                                  std::span<const CageFace> added) const;

  /// True when the exchange leaves the cage valid: each new face fits(), the halves of a symmetric
  /// cage stay apart, and no part of the model is lost.
  [[nodiscard]] bool allows(const QuadCage& cage, std::span<const Box3> boxes,
                            std::span<const Index> removed, std::span<CageFace> added,
                            bool tentative) const;

  /// True when the faces join vertices of a half cage's border along the border only: anything
  /// else would coincide with its mirror image.
  [[nodiscard]] static bool keeps_halves_apart(const QuadCage& cage,
                                               std::span<const CageFace> added);

  /// True when face f of the cage is within the limits if it is a quad, clear of the model, crosses
  /// nothing, and keeps the halves apart.
  [[nodiscard]] bool may_stand(const QuadCage& cage, std::span<const Box3> boxes, Index f) const;

  /// True when the quad is within the limits, clear of the model and crosses nothing, along either
  /// diagonal.
  [[nodiscard]] bool is_sound(const QuadCage& cage, std::span<const Vec3> positions,
                              std::span<const Box3> boxes, CageFace quad, Index itself) const;

private:
  [[nodiscard]] bool keeps_clear(std::span<const Vec3> positions, const Triangle& part) const;

  const ModelSurface* model_;
  double clearance_;
  QuadLimits limits_;
  KnownClear* known_ = nullptr;
};

Box3 box_of(std::span<const Vec3> positions, const CageFace& face);

/// True when some part of the model is outside the cage, or the whole that a half cage makes, at
/// these positions of its vertices.
bool loses_a_part(const ModelSurface& model, const QuadCage& cage, std::span<const Vec3> positions);

/// Two faces may have one corner or one side in common, which they run along opposite ways.
bool fit_together(const CageFace& s, const CageFace& t);

/// By number; empty for faces that are not there.
std::vector<Box3> face_boxes(const QuadCage& cage, std::span<const Vec3> positions);

} // namespace cagewright
