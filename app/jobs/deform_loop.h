/// \file
/// The model follows the cage, beside the GUI thread.
#pragma once

#include "app/document/document.h"

#include <QObject>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace cagewright::app {

/// Brings the document's deformed model and weight colours up to date whenever the cage as shown,
/// the binding or the selection changes. Work that is overtaken by newer work is left out, so that
/// a drag never lags, however large the model.
class DeformLoop final : public QObject {
  Q_OBJECT

public:
  explicit DeformLoop(Document& document, QObject* parent = nullptr);
  ~DeformLoop() override;

  /// Waits until the document shows the model for the cage as it is now.
  void finish();
  /// Waits until all that was asked for is made; the document shows it once events are handled.
  void wait();

  /// How long the last update of positions and normals took, in seconds.
  [[nodiscard]] double last_update_seconds() const { return last_update_seconds_; }

private:
  struct Request {
    std::shared_ptr<const Binding> binding;
    std::shared_ptr<const Binding> beside; ///< or null
    std::vector<Vec3> cage;                ///< C; empty: positions are up to date
    std::vector<Index> selected;           ///< cage vertices
    bool weights = false;                  ///< colours are asked for
  };
  struct Answer {
    std::shared_ptr<const Binding> binding;
    std::shared_ptr<DeformedModel> deformed; ///< null: unchanged
    std::shared_ptr<const Binding> by_beside;
    std::shared_ptr<DeformedModel> beside; ///< by that, with `deformed`
    std::optional<std::vector<float>> weights;
    double seconds = 0;
  };

  void ask_for_positions();
  void ask_for_weights();
  void run(const std::stop_token& stop);
  Answer answer(const Request& request);
  std::shared_ptr<DeformedModel> moved(const Binding& binding, std::span<const Vec3> cage);
  std::shared_ptr<DeformedModel> free_buffer();
  void deliver();

  Document& document_;
  double last_update_seconds_ = 0;

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable_any idle_;
  std::optional<Request> request_; // the next thing to do
  std::optional<Answer> answer_;   // not yet delivered
  bool working_ = false;
  std::vector<std::shared_ptr<DeformedModel>> buffers_; // of the thread
  std::jthread thread_;                                 // last: it uses all others
};

} // namespace cagewright::app
