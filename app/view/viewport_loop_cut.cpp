// Cutting a ring of quads: choosing it, how often, and where.
#include "app/edit/edit_cage.h"
#include "app/edit/select.h"
#include "app/view/viewport.h"

#include <QKeyEvent>

#include <algorithm>
#include <utility>

namespace cagewright::app {
namespace {

constexpr int most_cuts = 64;
// Loops do not reach the ends of the edges they cut.
constexpr double most_slide = 0.95;

} // namespace

void Viewport::begin_loop_cut() {
  if (!document_.has_cage() || drag_.is_active()) {
    return;
  }
  if (document_.mode() != Mode::refine) {
    Q_EMIT editor_.message(
        tr("the model is bound to this cage; go back to refining to change its faces"));
    return;
  }
  forget_outline();
  forget_hover();
  loop_cut_.emplace();
  aim_loop_cut();
  if (!loop_cut_->edge && document_.selection().mode == SelectionMode::edge &&
      !document_.selection().empty()) {
    loop_cut_->edge = document_.selection().edges.front(); // the pointer is elsewhere
    preview_loop_cut();
  }
}

/// The ring of the edge under the pointer.
void Viewport::aim_loop_cut() {
  refresh_graph();
  const std::optional<Pick> pick =
      picker().pick(camera_, cursor_, SelectionMode::edge, pick_options());
  if (pick) {
    loop_cut_->edge = graph_.edge(pick->element);
  }
  preview_loop_cut();
}

void Viewport::preview_loop_cut() {
  loop_cut_->lines.clear();
  if (loop_cut_->edge) {
    const Result<EditedCage> cut = loop_cut_result();
    if (cut) {
      for (const EdgeVertices& e : cut->selection.edges) {
        loop_cut_->lines.emplace_back(cut->mesh.positions[e[0]], cut->mesh.positions[e[1]]);
      }
    }
  }
  const int cuts = loop_cut_->cuts;
  caption_ = !loop_cut_->edge           ? tr("Loop cut: point at an edge")
             : loop_cut_->lines.empty() ? tr("Loop cut: no quads beside this edge")
             : loop_cut_->slides
                 ? tr("Loop cut: slide, %1 %").arg(std::lround(100 * loop_cut_->slide))
             : cuts == 1 ? tr("Loop cut: 1 loop")
                         : tr("Loop cut: %1 loops").arg(cuts);
  Q_EMIT hint(loop_cut_->slides
                  ? tr("Click or Enter: done \u00b7 right button: in the middle \u00b7 Esc: cancel")
                  : tr("Point at an edge \u00b7 wheel or + -: how many \u00b7 click or Enter: "
                       "place \u00b7 Esc: cancel"));
  update();
}

/// On both sides of the mirror plane where editing is symmetric.
Result<EditedCage> Viewport::loop_cut_result() {
  const EdgeVertices edge = *loop_cut_->edge;
  const PolygonMesh cage = document_.cage();
  const auto cut = [&](const PolygonMesh& mesh, const EdgeVertices& at, double slide) {
    return cut_loops(mesh, at, loop_cut_->cuts, slide);
  };
  Result<EditedCage> one = cut(cage, edge, loop_cut_->slide);
  if (!one || !document_.tools().symmetric) {
    return one;
  }
  const std::optional<Symmetry> symmetry = cage_symmetry(document_);
  const auto image = [&](Index v) { return symmetry ? symmetry->partner[v] : v; };
  const EdgeVertices other = {image(edge[0]), image(edge[1])};
  if (!symmetry || std::max(other[0], other[1]) >= cage.positions.size()) {
    return one;
  }
  const EdgeVertices there = {one->new_of_old[other[0]], one->new_of_old[other[1]]};
  if (!CageGraph(one->mesh).find_edge(there[0], there[1])) {
    // The ring is its own image: only in the middle are both sides alike.
    return loop_cut_->slide == 0 || other == edge ? std::move(one) : cut(cage, edge, 0);
  }
  Result<EditedCage> both = cut(one->mesh, there, loop_cut_->slide);
  if (!both) {
    return both;
  }
  std::vector<EdgeVertices>& edges = both->selection.edges;
  for (const EdgeVertices& e : one->selection.edges) {
    const Index a = both->new_of_old[e[0]];
    const Index b = both->new_of_old[e[1]];
    edges.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return both;
}

void Viewport::slide_loop_cut() {
  const auto [a, b] = *loop_cut_->edge;
  const std::span<const Vec3> positions = document_.shown_cage_positions();
  const auto from = camera_.project(positions[a]);
  const auto to = camera_.project(positions[b]);
  if (!from || !to) {
    return;
  }
  const Pixel along = to->pixel - from->pixel;
  const double length2 = std::max(along.squaredNorm(), 1.0);
  const double fraction = (cursor_ - loop_cut_->from).dot(along) / length2;
  loop_cut_->slide = std::clamp(fraction * (loop_cut_->cuts + 1), -most_slide, most_slide);
  preview_loop_cut();
}

void Viewport::add_loop_cuts(int more) {
  loop_cut_->cuts = std::clamp(loop_cut_->cuts + more, 1, most_cuts);
  preview_loop_cut();
}

/// From choosing to sliding, from sliding to done.
void Viewport::confirm_loop_cut() {
  if (!loop_cut_->edge) {
    return;
  }
  if (loop_cut_->lines.empty()) {
    Q_EMIT editor_.message(
        tr("loops go through quads, and there are none beside this edge: split it instead"));
    return;
  }
  if (!loop_cut_->slides) {
    loop_cut_->slides = true;
    loop_cut_->from = cursor_;
    preview_loop_cut();
    return;
  }
  Result<EditedCage> cut = loop_cut_result();
  end_loop_cut();
  if (cut) {
    editor_.edit_topology(std::move(cut->mesh), std::move(cut->selection), tr("Loop Cut"));
  } else {
    Q_EMIT editor_.message(QString::fromStdString(cut.error().message));
  }
}

void Viewport::end_loop_cut() {
  if (loop_cut_) {
    loop_cut_.reset();
    caption_.clear();
    Q_EMIT hint(QString());
    update();
  }
}

bool Viewport::loop_cut_key(QKeyEvent* event) {
  if (!loop_cut_) {
    return false;
  }
  switch (event->matches(QKeySequence::Undo) ? Qt::Key_Escape : event->key()) {
  case Qt::Key_Escape:
    end_loop_cut();
    break;
  case Qt::Key_Return:
  case Qt::Key_Enter:
    confirm_loop_cut();
    break;
  case Qt::Key_Plus:
  case Qt::Key_Equal:
  case Qt::Key_PageUp:
    add_loop_cuts(1);
    break;
  case Qt::Key_Minus:
  case Qt::Key_PageDown:
    add_loop_cuts(-1);
    break;
  default:
    break; // other keys wait until it is over
  }
  return true;
}

bool Viewport::loop_cut_press(Qt::MouseButton button) {
  if (!loop_cut_ || button == Qt::MiddleButton) {
    return false;
  }
  if (button == Qt::LeftButton) {
    confirm_loop_cut();
  } else if (loop_cut_->slides) {
    loop_cut_->slide = 0;
    confirm_loop_cut();
  } else {
    end_loop_cut();
  }
  return true;
}

} // namespace cagewright::app
