/// \file
/// The cage is judged and measured in the background whenever it has changed.
#pragma once

#include "app/document/document.h"
#include "app/jobs/job.h"

#include <QObject>
#include <QTimer>

#include <memory>
#include <optional>

namespace cagewright::app {

/// Keeps Document::check(), metrics(), cage_distances() and following() true. Starts when the cage
/// has been at rest for a moment; what is overtaken by another change is stopped.
class Checker final : public QObject {
  Q_OBJECT

public:
  explicit Checker(Document& document, QObject* parent = nullptr);
  ~Checker() override;

  /// Whether a check is due or under way.
  [[nodiscard]] bool busy() const {
    return job_ != nullptr || timer_.isActive() || following_ != nullptr ||
           following_timer_.isActive();
  }

Q_SIGNALS:
  void finished();

private:
  void cage_changed();
  void start();
  void update_distances();
  void follow();

  struct Known; ///< what is computed once for a model

  Document& document_;
  QTimer timer_;
  std::shared_ptr<Known> known_;
  Job* job_ = nullptr;
  QTimer following_timer_; // until the bound model is measured
  Job* following_ = nullptr;
};

} // namespace cagewright::app
