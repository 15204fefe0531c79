#include "app/jobs/deform_loop.h"

#include "app/document/binding.h"
#include "app/document/selected_vertices.h"
#include <cagewright/mesh/measures.h>

#include <atomic>
#include <chrono>
#include <utility>

namespace cagewright::app {

DeformLoop::DeformLoop(Document& document, QObject* parent)
    : QObject(parent), document_(document),
      thread_([this](const std::stop_token& stop) { run(stop); }) {
  connect(&document, &Document::cageMoved, this, &DeformLoop::ask_for_positions);
  connect(&document, &Document::modeChanged, this, &DeformLoop::ask_for_positions);
  connect(&document, &Document::besideChanged, this, &DeformLoop::ask_for_positions);
  connect(&document, &Document::modeChanged, this, &DeformLoop::ask_for_weights);
  connect(&document, &Document::selectionChanged, this, &DeformLoop::ask_for_weights);
  connect(&document, &Document::layersChanged, this, &DeformLoop::ask_for_weights);
}

DeformLoop::~DeformLoop() = default;

void DeformLoop::ask_for_positions() {
  const auto& binding = document_.state().binding;
  if (!binding) {
    return;
  }
  const std::span<const Vec3> cage = document_.shown_cage_positions();
  const std::lock_guard lock(mutex_);
  if (!request_ || request_->binding != binding) {
    request_.emplace();
    request_->binding = binding;
  }
  request_->cage.assign(cage.begin(), cage.end());
  request_->beside = document_.beside();
  wake_.notify_one();
}

void DeformLoop::ask_for_weights() {
  const auto& binding = document_.state().binding;
  const bool wanted = binding && document_.layers().weights && !document_.selection().empty();
  if (!wanted) {
    {
      const std::lock_guard lock(mutex_);
      if (request_) {
        request_->weights = false;
      }
    }
    if (!document_.model_weights().empty()) {
      document_.set_model_weights({});
    }
    return;
  }
  const std::lock_guard lock(mutex_);
  if (!request_ || request_->binding != binding) {
    request_.emplace();
    request_->binding = binding;
  }
  request_->selected = selected_vertices(document_.selection(), document_.cage_rest());
  request_->weights = true;
  wake_.notify_one();
}

void DeformLoop::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return request_.has_value(); })) {
    const Request request = *std::exchange(request_, std::nullopt);
    working_ = true;
    lock.unlock();
    Answer made = answer(request);
    lock.lock();
    working_ = false;
    if (answer_ && answer_->binding == made.binding) { // not delivered yet: the newer counts
      if (made.deformed == nullptr) {
        made.deformed = std::move(answer_->deformed);
        made.by_beside = std::move(answer_->by_beside);
        made.beside = std::move(answer_->beside);
      }
      if (!made.weights) {
        made.weights = std::move(answer_->weights);
      }
    }
    answer_ = std::move(made);
    idle_.notify_all();
    QMetaObject::invokeMethod(this, &DeformLoop::deliver, Qt::QueuedConnection);
  }
}

DeformLoop::Answer DeformLoop::answer(const Request& request) {
  Answer made;
  made.binding = request.binding;
  if (!request.cage.empty()) {
    const auto start = std::chrono::steady_clock::now();
    made.deformed = moved(*request.binding, request.cage);
    if (request.beside) {
      made.by_beside = request.beside;
      made.beside = moved(*request.beside, request.cage);
    }
    made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  if (request.weights) {
    made.weights = request.binding->influence(request.selected);
  }
  return made;
}

std::shared_ptr<DeformedModel> DeformLoop::moved(const Binding& binding,
                                                 std::span<const Vec3> cage) {
  Deformer& deformer = binding.deformer();
  for (std::size_t v = 0; v < cage.size(); ++v) {
    if (cage[v] != deformer.cage_positions()[v]) {
      deformer.move_cage_vertex(static_cast<Index>(v), cage[v]);
    }
  }
  deformer.update();
  std::shared_ptr<DeformedModel> made = free_buffer();
  binding.take(*made);
  made->box = bounding_box(made->positions);
  return made;
}

std::shared_ptr<DeformedModel> DeformLoop::free_buffer() {
  for (const std::shared_ptr<DeformedModel>& buffer : buffers_) {
    if (buffer.use_count() == 1) {
      std::atomic_thread_fence(std::memory_order_acquire); // after the GUI thread's last look at it
      return buffer;
    }
  }
  return buffers_.emplace_back(std::make_shared<DeformedModel>());
}

void DeformLoop::deliver() {
  std::optional<Answer> made;
  {
    const std::lock_guard lock(mutex_);
    made = std::exchange(answer_, std::nullopt);
  }
  if (!made || made->binding != document_.state().binding) {
    return;
  }
  if (made->deformed) {
    last_update_seconds_ = made->seconds;
    const bool is_beside = made->by_beside == document_.beside();
    document_.set_deformed(made->deformed, is_beside ? made->beside : nullptr);
  }
  if (made->weights && document_.layers().weights) {
    document_.set_model_weights(*std::move(made->weights));
  }
}

void DeformLoop::wait() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return !request_ && !working_; });
}

void DeformLoop::finish() {
  wait();
  deliver();
}

} // namespace cagewright::app
