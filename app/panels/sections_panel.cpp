#include "app/panels/sections_panel.h"

#include <QChart>
#include <QChartView>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineSeries>
#include <QLocale>
#include <QSignalBlocker>
#include <QSplitter>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <QValueAxis>

#include <algorithm>
#include <array>
#include <vector>

namespace cagewright::app {
namespace {

QString stop_text(StopReason reason) {
  switch (reason) {
  case StopReason::cut:
    return QObject::tr("cut");
  case StopReason::depth:
    return QObject::tr("depth reached");
  case StopReason::too_small:
    return QObject::tr("too small");
  case StopReason::prismatic:
    return QObject::tr("prismatic");
  case StopReason::no_jump:
    return QObject::tr("no clear jump");
  case StopReason::no_gain:
    return QObject::tr("no gain");
  case StopReason::max_boxes:
    return QObject::tr("most boxes reached");
  }
  return {};
}

} // namespace

SectionsPanel::SectionsPanel(Document& document, QWidget* parent)
    : QWidget(parent), document_(document) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  auto* splitter = new QSplitter;
  tree_ = new QTreeWidget;
  tree_->setObjectName("boxes_tree");
  tree_->setHeaderLabels({tr("Box"), tr("Depth"), tr("T1"), tr("T2"), tr("Why not cut")});
  tree_->setToolTip(tr("Select a box to see its cross-sections, and the box itself in the view"));
  splitter->addWidget(tree_);
  auto* right = new QWidget;
  auto* right_layout = new QVBoxLayout(right);
  right_layout->setContentsMargins(0, 0, 0, 0);
  auto* row = new QHBoxLayout;
  axis_ = new QComboBox;
  axis_->addItems({tr("Longest axis"), tr("Middle axis"), tr("Shortest axis")});
  axis_->setToolTip(tr("The axis of the box that the slices are across"));
  text_ = new QLabel;
  row->addWidget(axis_);
  row->addWidget(text_, 1);
  right_layout->addLayout(row);
  chart_ = new QChart;
  chart_->setMargins({2, 2, 2, 2});
  chart_->legend()->setAlignment(Qt::AlignTop);
  auto* view = new QChartView(chart_);
  view->setRenderHint(QPainter::Antialiasing);
  view->setMinimumSize(200, 30);
  tree_->setMinimumHeight(30);
  right_layout->addWidget(view, 1);
  splitter->addWidget(right);
  splitter->setStretchFactor(1, 2);
  layout->addWidget(splitter);

  connect(tree_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    Layers layers = document_.layers();
    layers.selected_box = item != nullptr ? item->data(0, Qt::UserRole).toInt() : -1;
    layers.boxes = layers.boxes || item != nullptr;
    document_.set_layers(layers);
    if (item != nullptr && document_.stages()) {
      const auto& node = document_.stages()->tree.nodes[item->data(0, Qt::UserRole).toUInt()];
      axis_->setCurrentIndex(node.cut ? node.cut->plane.axis : 0);
    }
    show_box();
  });
  connect(axis_, &QComboBox::currentIndexChanged, this, &SectionsPanel::show_box);
  connect(&document, &Document::stagesChanged, this, &SectionsPanel::fill_tree);
  fill_tree();
}

void SectionsPanel::set_dark(bool dark) {
  chart_->setTheme(dark ? QChart::ChartThemeDark : QChart::ChartThemeLight);
  chart_->setBackgroundRoundness(0);
  show_box();
}

void SectionsPanel::fill_tree() {
  const QSignalBlocker blocker(tree_);
  tree_->clear();
  if (document_.stages()) {
    const QLocale locale;
    const auto& nodes = document_.stages()->tree.nodes;
    std::vector<QTreeWidgetItem*> items(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const BoxNode& node = nodes[n];
      items[n] = node.parent < 0
                     ? new QTreeWidgetItem(tree_)
                     : new QTreeWidgetItem(items[static_cast<std::size_t>(node.parent)]);
      items[n]->setText(0, QString::number(n));
      items[n]->setText(1, QString::number(node.depth));
      items[n]->setText(2, locale.toString(node.prismatic_ratio, 'f', 2));
      items[n]->setText(3, locale.toString(node.cube_ratio, 'f', 2));
      items[n]->setText(4, node.cut ? QString() : stop_text(node.stop));
      items[n]->setData(0, Qt::UserRole, static_cast<int>(n));
    }
    tree_->expandAll();
    for (int column = 0; column < 5; ++column) {
      tree_->resizeColumnToContents(column);
    }
  }
  show_box();
}

void SectionsPanel::show_box() {
  chart_->removeAllSeries();
  for (QAbstractAxis* axis : chart_->axes()) {
    chart_->removeAxis(axis);
    delete axis;
  }
  const int selected = document_.layers().selected_box;
  if (!document_.stages() || selected < 0 ||
      static_cast<std::size_t>(selected) >= document_.stages()->tree.nodes.size()) {
    text_->setText(document_.stages() ? tr("Select a box")
                                      : tr("Show the layer Boxes to split the model"));
    return;
  }
  const BoxDecomposition& stages = *document_.stages();
  const BoxNode& node = stages.tree.nodes[static_cast<std::size_t>(selected)];
  const CrossSection& section = node.sections[static_cast<std::size_t>(axis_->currentIndex())];
  const double unit = stages.voxel_size();
  double most = 0;
  const auto add = [&](const std::vector<double>& f, const QString& name, const QPen& pen) {
    auto* series = new QLineSeries;
    series->setName(name);
    for (std::size_t k = 0; k < f.size(); ++k) {
      series->append((section.first + static_cast<double>(k) * section.step) * unit,
                     f[k] * unit * unit);
      most = std::max(most, f[k] * unit * unit);
    }
    series->setPen(pen);
    chart_->addSeries(series);
  };
  add(section.area, tr("f as sampled"), QPen(QColor("#8aa4c8"), 1));
  add(section.smooth, tr("f smoothed"), QPen(QColor("#2f6fd0"), 2));
  if (node.cut && node.cut->plane.axis == section.axis) {
    auto* cut = new QLineSeries;
    cut->setName(tr("cut"));
    cut->append(node.cut->plane.offset * unit, 0);
    cut->append(node.cut->plane.offset * unit, most * 1.05);
    cut->setPen(QPen(QColor("#d62a2a"), 2));
    chart_->addSeries(cut);
  }
  chart_->createDefaultAxes();
  if (!chart_->axes(Qt::Horizontal).isEmpty()) {
    chart_->axes(Qt::Horizontal).first()->setTitleText(tr("along the axis"));
    chart_->axes(Qt::Vertical).first()->setTitleText(tr("area"));
  }
  const QLocale locale;
  text_->setText(node.cut ? tr("Box %1, cut across its %2 axis; gain %3 %, jump %4 %")
                                .arg(selected)
                                .arg(std::array{
                                    tr("longest"), tr("middle"),
                                    tr("shortest")}[static_cast<std::size_t>(node.cut->plane.axis)])
                                .arg(locale.toString(100 * node.cut->gain, 'f', 1),
                                     locale.toString(100 * node.cut->jump, 'f', 1))
                          : tr("Box %1, not cut: %2").arg(selected).arg(stop_text(node.stop)));
}

} // namespace cagewright::app
