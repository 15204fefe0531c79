/// \file
/// What an empty window shows.
#pragma once

#include <QScrollArea>

class QVBoxLayout;

namespace cagewright::app {

/// How much of the work is done already in a sample.
enum class Sample { model, caged, bound };

/// What there is to do before a model is open: open one, try a sample, or go on with a file that
/// was opened before.
class WelcomePage final : public QScrollArea {
  Q_OBJECT

public:
  explicit WelcomePage(QWidget* parent = nullptr);
  /// The files opened last, the newest first.
  void set_recent(const QStringList& paths);

Q_SIGNALS:
  void openRequested();
  void fileRequested(const QString& path);
  void sampleRequested(Sample sample);
  void helpRequested();

private:
  QVBoxLayout* recent_ = nullptr;
};

} // namespace cagewright::app
