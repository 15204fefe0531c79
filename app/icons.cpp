#include "app/icons.h"

#include <QFile>
#include <QGuiApplication>
#include <QIconEngine>
#include <QPainter>
#include <QPalette>
#include <QPixmap>
#include <QSvgRenderer>

namespace cagewright::app {
namespace {

QColor color_of(QIcon::Mode mode, QIcon::State state) {
  const QPalette palette = QGuiApplication::palette();
  if (mode == QIcon::Disabled) {
    return palette.color(QPalette::Disabled, QPalette::ButtonText);
  }
  return palette.color(state == QIcon::On || mode == QIcon::Selected ? QPalette::HighlightedText
                                                                     : QPalette::ButtonText);
}

/// Draws lines that are black in the file in the color that is asked for.
class LineIcon final : public QIconEngine {
public:
  explicit LineIcon(QByteArray svg) : svg_(std::move(svg)) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
    QByteArray svg = svg_;
    svg.replace("#000", color_of(mode, state).name().toUtf8());
    QSvgRenderer(svg).render(painter, rect);
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    QPixmap pixmap(size);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    paint(&painter, QRect(QPoint(), size), mode, state);
    return pixmap;
  }
  [[nodiscard]] QIconEngine* clone() const override { return new LineIcon(svg_); }

private:
  QByteArray svg_;
};

} // namespace

QIcon icon(const QString& name) {
  QFile file(":/icons/" + name + ".svg");
  if (!file.open(QIODevice::ReadOnly)) {
    return {};
  }
  return QIcon(new LineIcon(file.readAll()));
}

} // namespace cagewright::app
