#include "app/panels/figures_panel.h"

#include "app/document/binding.h"

#include <QEvent>
#include <QFormLayout>
#include <QGuiApplication>
#include <QLabel>
#include <QListWidget>
#include <QLocale>
#include <QPalette>
#include <QVBoxLayout>

#include <array>

namespace cagewright::app {
namespace {

QString percent(double fraction, int decimals) {
  return QLocale().toString(100 * fraction, 'f', decimals) + " %";
}

QString plural(const char* one, const char* many, std::size_t count) {
  return count == 1 ? QObject::tr(one) : QObject::tr(many).arg(count);
}

/// The figures that only a bound model has.
constexpr std::array<const char*, 4> of_bound_model = {"unseen", "stretch", "volume_change",
                                                       "flipped"};

/// From where on a figure is good, and from where on it will do.
struct Levels {
  double good;
  double fair;
};

enum class Cue { good, fair, poor };

/// Read easily on light and on dark windows: a contrast of 4.5 at least.
const char* color_of(Cue cue) {
  const bool dark = QGuiApplication::palette().color(QPalette::Window).lightness() < 128;
  switch (cue) {
  case Cue::good:
    return dark ? "#5ccc78" : "#13762a";
  case Cue::fair:
    return dark ? "#e0b040" : "#8a5f00";
  case Cue::poor:
    break;
  }
  return dark ? "#ff7b72" : "#b81f1f";
}

/// The figure with a word that says whether it is good; larger values are better.
QString with_cue(const QString& figure, double value, const Levels& levels) {
  const Cue cue = value >= levels.good ? Cue::good : value >= levels.fair ? Cue::fair : Cue::poor;
  return QString("%1 <span style='color:%2'>%3</span>")
      .arg(figure, color_of(cue),
           cue == Cue::good   ? QObject::tr("good")
           : cue == Cue::fair ? QObject::tr("fair")
                              : QObject::tr("poor"));
}

} // namespace

QString describe(ViolationKind kind, std::size_t count) {
  switch (kind) {
  case ViolationKind::no_faces:
    return QObject::tr("The cage has no faces");
  case ViolationKind::bad_corner:
    return plural("A face has too few corners", "%1 faces have too few corners", count);
  case ViolationKind::not_finite:
    return plural("A vertex is not finite", "%1 vertices are not finite", count);
  case ViolationKind::unused_vertex:
    return plural("A vertex belongs to no face", "%1 vertices belong to no face", count);
  case ViolationKind::coincident_vertices:
    return plural("Two vertices are in the same place", "%1 pairs of vertices coincide", count);
  case ViolationKind::degenerate_face:
    return plural("A face has no area", "%1 faces have no area", count);
  case ViolationKind::folded_face:
    return plural("A face folds over itself", "%1 faces fold over themselves", count);
  case ViolationKind::duplicate_face:
    return plural("A face is there twice", "%1 faces are there twice", count);
  case ViolationKind::open_edge:
    return plural("The cage has an open edge", "The cage has %1 open edges", count);
  case ViolationKind::t_junction:
    return plural("A vertex lies on an edge of a face that does not have it",
                  "%1 vertices lie on edges of faces that do not have them", count);
  case ViolationKind::nonmanifold_edge:
    return plural("An edge has more than two faces", "%1 edges have more than two faces", count);
  case ViolationKind::flipped_edge:
    return plural("Two neighboring faces look opposite ways",
                  "%1 pairs of neighboring faces look opposite ways", count);
  case ViolationKind::nonmanifold_vertex:
    return plural("Faces touch in a vertex only", "Faces touch in %1 vertices only", count);
  case ViolationKind::self_intersection:
    return plural("Two faces of the cage cross", "%1 pairs of faces of the cage cross", count);
  case ViolationKind::inverted_piece:
    return plural("The cage is inside out", "%1 pieces are inside out", count);
  case ViolationKind::several_pieces:
    return plural("There is a second piece", "There are %1 more pieces", count);
  case ViolationKind::nested_piece:
    return plural("A piece lies within another", "%1 pieces lie within others", count);
  case ViolationKind::vertex_outside:
    return plural("A vertex of the model is outside", "%1 vertices of the model are outside",
                  count);
  case ViolationKind::vertex_on_cage:
    return plural("A vertex of the model lies on the cage",
                  "%1 vertices of the model lie on the cage", count);
  case ViolationKind::face_contact:
    return plural("A face of the model touches the cage", "%1 faces of the model touch the cage",
                  count);
  }
  return {};
}

FiguresPanel::FiguresPanel(Document& document, QWidget* parent)
    : QWidget(parent), document_(document) {
  auto* layout = new QVBoxLayout(this);
  verdict_ = new QLabel;
  verdict_->setObjectName("verdict");
  verdict_->setWordWrap(true);
  layout->addWidget(verdict_);
  auto* form = new QFormLayout;
  form->setVerticalSpacing(2);
  layout->addLayout(form);
  const auto add = [&](const char* key, const QString& label, const QString& help) {
    auto* value = new QLabel("-");
    value->setObjectName(key);
    value->setTextInteractionFlags(Qt::TextSelectableByMouse);
    value->setWordWrap(true);
    value->setToolTip(help);
    form->addRow(label, value);
    form->labelForField(value)->setToolTip(help);
    values_[key] = value;
    labels_[key] = form->labelForField(value);
  };
  add("vertices", tr("Vertices"), tr("Of the cage"));
  add("faces", tr("Faces"), tr("Of the cage: polygons, and triangles when they are cut"));
  add("volume_ratio", tr("Volume ratio"),
      tr("Volume of the cage divided by that of the model. Up to 2 the cage follows its form"));
  add("gap", tr("Least gap"),
      tr("Least distance between cage and model, of the diagonal. From 0.1 % on every program can "
         "bind the model"));
  add("mean_gap", tr("Mean gap"),
      tr("Mean distance from the cage to the model, of the diagonal. Up to 3 % the model moves "
         "where the cage does"));
  add("quality", tr("Face quality"),
      tr("Of the worst face: 1 for an equilateral triangle, 0 for one without area. Below 0.05 "
         "faces are needles that are hard to grasp"));
  add("unseen", tr("Unseen share"),
      tr("How much of the bound model's weights belongs to vertices of the cage that its points do "
         "not see: by so much a limb is dragged by what lies across a gap. Below 5 % little is "
         "seen of it; other coordinates, or a cage with gaps between the limbs, have less"));
  add("stretch", tr("Stretch"),
      tr("Of the surface of the bound model as it is now: how many times as long, or as short, a "
         "line on it became at most, but for the worst 5 % of the area"));
  add("volume_change", tr("Volume change"), tr("Of the bound model as it is now"));
  add("flipped", tr("Folded over"),
      tr("Triangles of the bound model that look against those round them, and did not at rest"));
  add("model", tr("Model"), tr("Vertices and triangles of the model"));
  problems_ = new QListWidget;
  problems_->setObjectName("problems");
  problems_->setToolTip(tr("What the check found, drawn where it is. A click selects it and brings "
                           "it into view; the next click goes to the next one."));
  connect(problems_, &QListWidget::itemClicked, this,
          [this](QListWidgetItem* item) { choose(problems_->row(item)); });
  problems_->setWordWrap(true);
  problems_->setMinimumHeight(40);
  layout->addWidget(problems_, 1);
  layout->addStretch();
  connect(&document, &Document::cageChanged, this, &FiguresPanel::update_figures);
  connect(&document, &Document::metricsChanged, this, &FiguresPanel::update_figures);
  connect(&document, &Document::modelChanged, this, &FiguresPanel::update_figures);
  connect(&document, &Document::checkChanged, this, &FiguresPanel::update_figures);
  connect(&document, &Document::modeChanged, this, &FiguresPanel::update_figures);
  connect(&document, &Document::followingChanged, this, &FiguresPanel::update_figures);
  connect(&document, &Document::cageChanged, this, &FiguresPanel::update_check);
  connect(&document, &Document::checkChanged, this, &FiguresPanel::update_check);
  update_figures();
  update_check();
}

void FiguresPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && problems_ != nullptr) {
    update_figures();
    update_check();
  }
}

void FiguresPanel::choose(int row) {
  const auto& report = document_.check().report;
  if (!report || row < 0 || row >= static_cast<int>(kinds_.size())) {
    return;
  }
  next_ = row == chosen_ ? next_ + 1 : 0;
  chosen_ = row;
  std::vector<const Violation*> found;
  for (const Violation& violation : report->violations) {
    if (violation.kind == kinds_[static_cast<std::size_t>(row)]) {
      found.push_back(&violation);
    }
  }
  if (!found.empty()) {
    Q_EMIT violationChosen(*found[next_ % found.size()]);
  }
}

void FiguresPanel::show_row(const char* key, bool on) {
  values_[key]->setVisible(on);
  labels_[key]->setVisible(on);
}

void FiguresPanel::update_figures() {
  const QLocale locale;
  const auto set = [&](const char* key, const QString& text) { values_[key]->setText(text); };
  const auto count = [&](std::size_t n) { return locale.toString(static_cast<qulonglong>(n)); };
  for (auto& [key, label] : values_) {
    label->setText("-");
  }
  if (document_.has_model()) {
    set("model", tr("%1 vertices, %2 triangles")
                     .arg(count(document_.model()->mesh.positions.size()),
                          count(document_.model()->triangles.size())));
  }
  if (!document_.has_cage()) {
    for (const char* of_bound : of_bound_model) {
      show_row(of_bound, false);
    }
    return;
  }
  const PolygonMesh& cage = document_.cage_rest();
  const std::size_t triangles = cage.corners().size() - 2 * cage.face_count();
  set("vertices", count(cage.positions.size()));
  set("faces", triangles == cage.face_count()
                   ? count(triangles)
                   : tr("%1 (%2 triangles)").arg(count(cage.face_count()), count(triangles)));
  for (const char* of_bound : of_bound_model) {
    show_row(of_bound, document_.mode() == Mode::deform);
  }
  if (const auto& binding = document_.state().binding) {
    if (const auto& unseen = binding->unseen()) {
      set("unseen", with_cue(percent(unseen->mean, 1), -unseen->mean, {-0.05, -0.2}));
    }
    if (const auto& figures = document_.following()) {
      set("stretch", with_cue(locale.toString(figures->high_stretch, 'f', 2),
                              -figures->high_stretch, {-1.5, -3}));
      set("volume_change", percent(figures->volume_change, 1));
      set("flipped", figures->flipped == 0 ? with_cue(tr("none"), 0, {0, 0})
                                           : with_cue(count(figures->flipped), -1, {0, 0}));
    }
  }
  // How a cage that is none compares is no praise of it.
  const auto& report = document_.check().report;
  const auto& metrics = document_.metrics();
  if (metrics && (!report || report->valid())) {
    set("volume_ratio", metrics->volume_ratio > 0
                            ? with_cue(locale.toString(metrics->volume_ratio, 'f', 3),
                                       -metrics->volume_ratio, {-2, -3.5})
                            : "-");
    set("gap", with_cue(percent(metrics->clearance, 3), metrics->clearance, {1e-3, 2e-4}));
    set("mean_gap",
        with_cue(percent(metrics->mean_distance, 2), -metrics->mean_distance, {-0.03, -0.06}));
    set("quality", with_cue(locale.toString(metrics->min_quality, 'f', 3), metrics->min_quality,
                            {0.05, 0.01}));
  }
}

void FiguresPanel::update_check() {
  problems_->clear();
  kinds_.clear();
  chosen_ = -1;
  const CageCheck& check = document_.check();
  const auto say = [&](const QString& text, const char* color) {
    verdict_->setText(QString("<span style='color:%1; font-size:14pt'>&#9679;</span> <b>%2</b>")
                          .arg(color, text));
  };
  if (!document_.has_cage()) {
    say(tr("No cage yet"), "gray");
  } else if (!document_.offending_faces().empty() && check.state != CageCheck::State::done) {
    say(tr("Not valid here"), color_of(Cue::poor));
  } else if (check.state == CageCheck::State::checking) {
    say(tr("Checking..."), color_of(Cue::fair));
  } else if (!check.report) {
    say(tr("Not checked"), "gray");
  } else if (check.report->valid()) {
    say(tr("Valid"), color_of(Cue::good));
  } else {
    say(tr("Not valid"), color_of(Cue::poor));
    for (std::size_t k = 0; k < violation_kinds; ++k) {
      if (check.report->counts[k] > 0) {
        kinds_.push_back(static_cast<ViolationKind>(k));
        problems_->addItem(describe(static_cast<ViolationKind>(k), check.report->counts[k]));
      }
    }
  }
  problems_->setVisible(problems_->count() > 0);
}

} // namespace cagewright::app
