#include "app/jobs/checker.h"

#include "app/jobs/work.h"

#include <mutex>
#include <utility>

namespace cagewright::app {

struct Checker::Known {
  std::mutex mutex;
  std::optional<ModelVolume> volume;
};

namespace {

constexpr int quiet_ms = 120;

} // namespace

Checker::Checker(Document& document, QObject* parent)
    : QObject(parent), document_(document), known_(std::make_shared<Known>()) {
  timer_.setSingleShot(true);
  timer_.setInterval(quiet_ms);
  connect(&timer_, &QTimer::timeout, this, &Checker::start);
  connect(&document, &Document::modelChanged, this, [this] {
    known_ = std::make_shared<Known>();
    cage_changed();
  });
  connect(&document, &Document::regionChanged, this, [this] {
    known_ = std::make_shared<Known>();
    cage_changed();
  });
  connect(&document, &Document::cageChanged, this, &Checker::cage_changed);
  connect(&document, &Document::cageMoved, this, [this] {
    if (document_.mode() == Mode::refine) {
      cage_changed();
    }
  });
  connect(&document, &Document::layersChanged, this, &Checker::update_distances);
  following_timer_.setSingleShot(true);
  following_timer_.setInterval(quiet_ms);
  connect(&following_timer_, &QTimer::timeout, this, &Checker::follow);
  connect(&document, &Document::modelMoved, this, [this] {
    if (document_.mode() == Mode::deform && document_.deformed()) {
      following_timer_.start();
    }
  });
}

Checker::~Checker() {
  delete job_;
  delete following_;
}

void Checker::cage_changed() {
  if (job_ != nullptr) {
    job_->cancel();
  }
  update_distances();
  if (!document_.has_cage()) {
    timer_.stop();
    document_.set_metrics({});
    return;
  }
  CageCheck check = document_.check();
  if (check.state != CageCheck::State::checking) {
    check.state = CageCheck::State::checking;
    document_.set_check(std::move(check));
  }
  timer_.start();
}

void Checker::start() {
  if (job_ != nullptr) { // it has been told to stop: its end comes back here
    return;
  }
  job_ = new Job(tr("Check"));
  connect(job_, &Job::finished, this, [this] {
    const bool stopped = job_->cancelled();
    std::exchange(job_, nullptr)->deleteLater();
    if (stopped) {
      if (!timer_.isActive() && document_.has_cage()) {
        timer_.start();
      }
    } else {
      Q_EMIT finished();
    }
  });
  // In deform mode it is the rest that has to be valid.
  const PolygonMesh cage =
      document_.mode() == Mode::refine ? document_.cage() : document_.cage_rest();
  job_->start([this, cage, model = document_.caged().shared_model(),
               known = known_](const Progress& progress) -> Result<Job::Apply> {
    Result<JudgedCage> judged = judge_cage(cage, model.get(), progress);
    if (!judged) {
      return judged.error();
    }
    std::optional<CageMetrics> metrics;
    if (model) {
      const std::lock_guard lock(known->mutex);
      if (!known->volume) {
        known->volume = model_volume(model->view());
      }
      metrics = measure_cage(cage, model->view(), known->volume);
    }
    return Job::Apply([this, judged = *judged, metrics] {
      document_.set_offending_faces(judged.offending_faces);
      document_.set_check({CageCheck::State::done, judged.report});
      document_.set_metrics(metrics);
    });
  });
}

/// Measures what became of the bound model, once it rests.
void Checker::follow() {
  if (following_ != nullptr) { // it comes back here
    following_timer_.start();
    return;
  }
  if (document_.mode() != Mode::deform || !document_.deformed()) {
    return;
  }
  following_ = new Job(tr("Measure"));
  connect(following_, &Job::finished, this,
          [this] { std::exchange(following_, nullptr)->deleteLater(); });
  following_->start([this, model = document_.model(), deformed = document_.deformed(),
                     binding = document_.state().binding](const Progress&) -> Result<Job::Apply> {
    const DeformedFigures figures = deformed_figures(model->view(), deformed->positions);
    return Job::Apply([this, figures, binding] {
      if (document_.state().binding == binding) {
        document_.set_following(figures);
      }
    });
  });
}

void Checker::update_distances() {
  const bool wanted = document_.layers().distance && document_.has_cage() && document_.has_model();
  std::vector<float> distances;
  if (wanted) {
    const Model& model = document_.caged().model();
    for (const Vec3& p : document_.cage_positions()) {
      distances.push_back(static_cast<float>(model.bvh.nearest(p).distance / model.diagonal));
    }
  }
  if (wanted || !document_.cage_distances().empty()) {
    document_.set_cage_distances(std::move(distances));
  }
}

} // namespace cagewright::app
