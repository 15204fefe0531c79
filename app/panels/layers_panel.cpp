#include "app/panels/layers_panel.h"

#include <QAction>
#include <QActionGroup>
#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace cagewright::app {
namespace {

struct Entry {
  const char* name;
  const char* label;
  const char* help;
  bool Layers::*value;
  bool needs_stages = false;
};

struct Group {
  const char* title;
  std::vector<Entry> entries;
};

const std::vector<Group>& groups() {
  static const std::vector<Group> all = {
      {"Model",
       {{"model", "Surface", "The model, shaded", &Layers::model},
        {"smooth_normals", "Smooth", "Smooth shading; otherwise each face is flat",
         &Layers::smooth_normals},
        {"wireframe", "Wireframe", "The edges of the model", &Layers::wireframe},
        {"occlusion", "Shade in corners",
         "Corners and folds are darker. Drawn as soon as nothing moves", &Layers::occlusion},
        {"weights", "Weights of the selection",
         "Colors: how much each point of the model follows the selected cage vertices. Needs a "
         "bound model",
         &Layers::weights}}},
      {"Cage",
       {{"cage_edges", "Edges", "The edges of the cage", &Layers::cage_edges},
        {"cage_faces", "Faces", "The faces of the cage, translucent", &Layers::cage_faces},
        {"cage_vertices", "Vertices", "The vertices of the cage", &Layers::cage_vertices},
        {"rest_cage", "At rest", "While deforming: also the cage at rest", &Layers::rest_cage},
        {"distance", "Distance to the model", "Colors: how far the cage is from the model",
         &Layers::distance},
        {"problems", "Problems", "What the check found, where it is", &Layers::problems}}},
      {"How it was split",
       {{"boxes", "Boxes", "The oriented boxes at the depth below", &Layers::boxes, true},
        {"cuts", "Cuts", "The planes in which the boxes were cut", &Layers::cuts, true},
        {"feature_voxels", "Voxels on the surface", "Voxels that the surface runs through",
         &Layers::feature_voxels, true},
        {"inner_voxels", "Voxels inside", "Voxels wholly inside", &Layers::inner_voxels, true}}},
      {"Around", {{"grid", "Ground", "A grid on the ground", &Layers::grid}}}};
  return all;
}

bool needs_stages(const Layers& layers) {
  return layers.boxes || layers.cuts || layers.feature_voxels || layers.inner_voxels;
}

} // namespace

LayersPanel::LayersPanel(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setSpacing(2);
  for (const Group& group : groups()) {
    layout->addWidget(new QLabel("<b>" + tr(group.title) + "</b>"));
    for (const Entry& entry : group.entries) {
      auto* box = new QCheckBox(tr(entry.label));
      box->setObjectName(entry.name);
      box->setToolTip(tr(entry.help));
      connect(box, &QCheckBox::toggled, this,
              [this, value = entry.value](bool on) { set_layer(value, on); });
      layout->addWidget(box);
      switches_.push_back({box, entry.value, nullptr});
    }
    if (std::string_view(group.title) == "How it was split") {
      auto* row = new QHBoxLayout;
      auto* less = new QToolButton;
      less->setText("-");
      less->setToolTip(tr("One cut less deep ([)"));
      auto* more = new QToolButton;
      more->setText("+");
      more->setToolTip(tr("One cut deeper (])"));
      depth_ = new QSlider(Qt::Horizontal);
      depth_->setObjectName("shown_depth");
      depth_->setPageStep(1);
      depth_->setToolTip(tr("How many cuts deep the boxes are shown: step through them to watch "
                            "the splitting"));
      depth_text_ = new QLabel;
      row->addWidget(less);
      row->addWidget(depth_, 1);
      row->addWidget(more);
      layout->addLayout(row);
      layout->addWidget(depth_text_);
      connect(less, &QToolButton::clicked, this, [this] { step_depth(-1); });
      connect(more, &QToolButton::clicked, this, [this] { step_depth(1); });
      connect(depth_, &QSlider::valueChanged, this, [this](int value) {
        Layers layers = session_.document().layers();
        layers.depth = value;
        layers.boxes = layers.boxes || !needs_stages(layers);
        session_.document().set_layers(layers);
        ensure_stages();
      });
    }
    if (std::string_view(group.title) == "Model") {
      add_looks(layout);
    }
    layout->addSpacing(6);
  }
  layout->addStretch();
  connect(&session.document(), &Document::layersChanged, this, &LayersPanel::update_switches);
  connect(&session.document(), &Document::stagesChanged, this, &LayersPanel::update_depth);
  update_switches();
  update_depth();
}

void LayersPanel::add_looks(QVBoxLayout* layout) {
  auto* row = new QHBoxLayout;
  row->addWidget(new QLabel(tr("Looks like")));
  look_ = new QComboBox;
  look_->setObjectName("look");
  // In the order of SurfaceLook.
  look_->addItems(
      {tr("Plain"), tr("Clay"), tr("Wax"), tr("Metal"), tr("Stripes"), tr("Its own colors")});
  look_->setToolTip(tr("What the model is made of, as it were. Metal and stripes show bumps and "
                       "kinks that a deformation makes. Its own colors are those of its file: "
                       "materials, textures, colors of vertices and faces"));
  row->addWidget(look_, 1);
  layout->addLayout(row);
  connect(look_, &QComboBox::currentIndexChanged, this, &LayersPanel::set_look);
}

void LayersPanel::add_to(QMenu* menu) {
  std::size_t number = 0;
  for (const Group& group : groups()) {
    for (const Entry& entry : group.entries) {
      QAction* command = menu->addAction(tr("%1: %2").arg(tr(group.title), tr(entry.label)));
      command->setObjectName(QString("layer_") + entry.name);
      command->setStatusTip(tr(entry.help));
      command->setToolTip(tr(entry.help));
      command->setCheckable(true);
      connect(command, &QAction::triggered, this,
              [this, value = entry.value](bool on) { set_layer(value, on); });
      switches_[number++].command = command;
    }
    menu->addSeparator();
  }
  look_commands_ = new QActionGroup(this);
  for (int look = 0; look < look_->count(); ++look) {
    QAction* command = menu->addAction(tr("Looks like: %1").arg(look_->itemText(look)));
    command->setObjectName(QString("look_%1").arg(look));
    command->setStatusTip(look_->toolTip());
    command->setToolTip(look_->toolTip());
    command->setCheckable(true);
    look_commands_->addAction(command);
    connect(command, &QAction::triggered, this, [this, look] { set_look(look); });
  }
  update_switches();
}

void LayersPanel::set_layer(bool Layers::*value, bool on) {
  Layers layers = session_.document().layers();
  layers.*value = on;
  session_.document().set_layers(layers);
  ensure_stages();
}

void LayersPanel::set_look(int look) {
  Layers layers = session_.document().layers();
  layers.look = static_cast<SurfaceLook>(look);
  session_.document().set_layers(layers);
}

void LayersPanel::step_depth(int by) {
  Layers layers = session_.document().layers();
  const int deepest = session_.document().stage_depth();
  const int now = layers.depth < 0 ? deepest : layers.depth;
  layers.depth = std::clamp(now + by, 0, std::max(deepest, 0));
  layers.boxes = true;
  session_.document().set_layers(layers);
  ensure_stages();
}

void LayersPanel::ensure_stages() {
  const Document& document = session_.document();
  if (needs_stages(document.layers()) && !document.stages() && document.has_model() &&
      !session_.jobs().busy()) {
    session_.make_stages();
  }
}

void LayersPanel::update_switches() {
  const Layers& layers = session_.document().layers();
  for (const Switch& s : switches_) {
    const QSignalBlocker blocker(s.box);
    s.box->setChecked(layers.*s.value);
    if (s.command != nullptr) {
      s.command->setChecked(layers.*s.value);
    }
  }
  const QSignalBlocker blocker(look_);
  look_->setCurrentIndex(static_cast<int>(layers.look));
  if (look_commands_ != nullptr) {
    look_commands_->actions()[look_->currentIndex()]->setChecked(true);
  }
  update_depth();
}

void LayersPanel::update_depth() {
  const Document& document = session_.document();
  const QSignalBlocker blocker(depth_);
  const int deepest = document.stage_depth();
  const int depth = document.layers().depth < 0 ? deepest : document.layers().depth;
  depth_->setRange(0, deepest);
  depth_->setValue(depth);
  depth_->setEnabled(document.stages() != nullptr);
  if (document.stages()) {
    const auto boxes = document.stages()->tree.cover(depth).size();
    depth_text_->setText(tr("Depth %1 of %2: %L3 boxes").arg(depth).arg(deepest).arg(boxes));
  } else {
    depth_text_->setText(tr("Not split yet"));
  }
}

} // namespace cagewright::app
