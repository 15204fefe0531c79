#include "app/session.h"

#include "app/document/binding.h"
#include "app/document/time_line.h"
#include "app/jobs/work.h"
#include <cagewright/io/write_mesh.h>

#include <QFileInfo>
#include <QRegularExpression>
#include <QSet>

#include <algorithm>
#include <utility>

namespace cagewright::app {
namespace {

namespace fs = std::filesystem;

QString name_of(const fs::path& path) {
  return QString::fromStdString(path.filename().string());
}

bool is_project(const fs::path& path) {
  return QString::fromStdString(path.extension().string()).toLower() == ".cagewright";
}

SharedPositions shared(std::span<const Vec3> positions) {
  return std::make_shared<const std::vector<Vec3>>(positions.begin(), positions.end());
}

} // namespace

fs::path with_suffix(const fs::path& path, const QString& suffix) {
  QString clean = suffix;
  clean.replace(QRegularExpression("[^\\w.+-]"), "_");
  return path.parent_path() /
         (path.stem().string() + clean.toStdString() + path.extension().string());
}

Session::Session(QObject* parent)
    : QObject(parent), editor_(document_), deform_loop_(document_), checker_(document_) {
  connect(&jobs_, &JobRunner::failed, this, &Session::failed);
  connect(&jobs_, &JobRunner::cancelled, this,
          [this](const QString& title) { Q_EMIT message(tr("%1: cancelled").arg(title)); });
  connect(&editor_, &Editor::message, this, &Session::message);
  connect(&editor_.undo_stack(), &QUndoStack::cleanChanged, this, &Session::titleChanged);
}

Session::~Session() = default;

void Session::set_settings(const GenerateSettings& settings) {
  settings_ = settings;
  Q_EMIT settingsChanged();
}

bool Session::start(const QString& title, Job::Work work) {
  if (jobs_.run(title, std::move(work))) {
    return true;
  }
  Q_EMIT message(tr("Wait for \"%1\" to end, or cancel it").arg(jobs_.title()));
  return false;
}

bool Session::report(const QString& title, const Status& status) {
  if (!status) {
    Q_EMIT failed(title, QString::fromStdString(status.error().message));
  }
  return status.has_value();
}

// ---- Opening

void Session::open(const fs::path& path, const fs::path& cage) {
  if (is_project(path)) {
    open_project(path, {}, false);
    return;
  }
  start(tr("Open"), [this, path, cage](const Progress& progress) -> Result<Job::Apply> {
    Result<std::shared_ptr<const Model>> model = app::open_model(path, progress.part(0, 0.9));
    if (!model) {
      return model.error();
    }
    std::shared_ptr<const PolygonMesh> mesh;
    if (!cage.empty()) {
      Result<std::shared_ptr<const PolygonMesh>> read = read_cage(cage);
      if (!read) {
        return read.error();
      }
      mesh = *read;
    }
    return Job::Apply([this, path, model = *model, mesh] {
      document_.set_model(model);
      if (mesh) {
        editor_.replace_cage(mesh, nullptr, tr("Load Cage"));
      }
      editor_.undo_stack().clear();
      project_path_.clear();
      modified_ = false;
      Q_EMIT titleChanged();
      Q_EMIT cameraRestored({});
      Q_EMIT opened(QString::fromStdString(path.string()));
      Q_EMIT message(tr("%1: %L2 vertices, %L3 triangles")
                         .arg(name_of(path))
                         .arg(model->mesh.positions.size())
                         .arg(model->triangles.size()));
    });
  });
}

void Session::load_cage(const fs::path& path) {
  start(tr("Load Cage"), [this, path](const Progress&) -> Result<Job::Apply> {
    Result<std::shared_ptr<const PolygonMesh>> mesh = read_cage(path);
    if (!mesh) {
      return mesh.error();
    }
    return Job::Apply([this, path, mesh = *mesh] {
      editor_.replace_cage(mesh, nullptr, tr("Load Cage"));
      Q_EMIT message(tr("%1: %L2 vertices, %L3 faces")
                         .arg(name_of(path))
                         .arg(mesh->positions.size())
                         .arg(mesh->face_count()));
    });
  });
}

void Session::open_project_with_model(const fs::path& project, const fs::path& model) {
  open_project(project, model, false);
}

void Session::recover(const fs::path& path) {
  open_project(path, {}, true);
}

void Session::open_project(const fs::path& path, const fs::path& model_path, bool recovered) {
  Result<Project> read = read_project(path);
  if (!read) {
    Q_EMIT failed(tr("Open Project"), QString::fromStdString(read.error().message));
    return;
  }
  if (!model_path.empty()) {
    read->model_path = model_path;
  }
  std::error_code error;
  if (!read->model_path.empty() && !fs::exists(read->model_path, error)) {
    Q_EMIT modelMissing(QString::fromStdString(path.string()),
                        QString::fromStdString(read->model_path.string()));
    return;
  }
  start(tr("Open Project"),
        [this, path, recovered, project = *read](const Progress& progress) -> Result<Job::Apply> {
          std::shared_ptr<const Model> model;
          std::shared_ptr<const Binding> binding;
          if (!project.model_path.empty()) {
            Result<std::shared_ptr<const Model>> opened =
                app::open_model(project.model_path, progress.part(0, 0.4));
            if (!opened) {
              return opened.error();
            }
            model = *opened;
          }
          if (project.bound && model) {
            Result<std::shared_ptr<const Binding>> bound =
                bind_model(*model, *project.state.rest, progress.part(0.4, 1));
            if (!bound) {
              return bound.error();
            }
            binding = *bound;
          }
          return Job::Apply([this, path, recovered, project, model, binding] {
            restore(project, model, binding);
            project_path_ = recovered ? fs::path() : path;
            modified_ = recovered;
            Q_EMIT titleChanged();
            if (!recovered) {
              Q_EMIT opened(QString::fromStdString(path.string()));
            }
            if (model && model->checksum != project.model_checksum) {
              Q_EMIT failed(tr("Open Project"),
                            tr("The model %1 has changed since the project was saved. The cage "
                               "may no longer fit it.")
                                .arg(name_of(project.model_path)));
            }
          });
        });
}

void Session::restore(const Project& project, std::shared_ptr<const Model> model,
                      std::shared_ptr<const Binding> binding) {
  document_.set_model(std::move(model));
  State state = project.state;
  state.binding = std::move(binding);
  document_.set_state(state);
  editor_.undo_stack().clear();
  document_.set_layers(project.layers);
  document_.set_tools(project.tools);
  set_settings(project.settings);
  Q_EMIT cameraRestored(project.camera);
}

// ---- Working

void Session::generate() {
  if (!document_.has_model()) {
    Q_EMIT message(tr("Open a model first"));
    return;
  }
  start(tr("Generate"),
        [this, model = document_.model(),
         settings = settings_](const Progress& progress) -> Result<Job::Apply> {
          Result<MadeCage> made = make_cage(*model, settings, progress);
          if (!made) {
            return made.error();
          }
          return Job::Apply([this, model, made = *made] {
            if (document_.model() != model) {
              return; // another one was opened meanwhile
            }
            editor_.replace_cage(made.cage, made.stages, tr("Generate Cage"));
            const QString what = tr("A valid cage of %L1 vertices and %L2 faces")
                                     .arg(made.cage->positions.size())
                                     .arg(made.cage->face_count());
            Q_EMIT message(made.remark.isEmpty() ? what : what + "; " + made.remark);
          });
        });
}

void Session::make_stages() {
  if (!document_.has_model()) {
    Q_EMIT message(tr("Open a model first"));
    return;
  }
  start(tr("Split"),
        [this, model = document_.model(),
         settings = settings_](const Progress& progress) -> Result<Job::Apply> {
          Result<std::shared_ptr<const BoxDecomposition>> stages =
              app::make_stages(*model, settings, progress);
          if (!stages) {
            return stages.error();
          }
          return Job::Apply([this, model, stages = *stages] {
            if (document_.model() == model) {
              document_.set_stages(stages);
            }
          });
        });
}

void Session::bind() {
  if (!document_.has_model() || !document_.has_cage() || document_.mode() == Mode::deform) {
    Q_EMIT message(tr("Binding needs a model and a cage"));
    return;
  }
  auto rest = std::make_shared<const PolygonMesh>(document_.cage());
  start(tr("Bind"),
        [this, model = document_.model(), rest,
         cage = document_.state().cage](const Progress& progress) -> Result<Job::Apply> {
          Result<std::shared_ptr<const Binding>> binding = bind_model(*model, *rest, progress);
          if (!binding) {
            return binding.error();
          }
          return Job::Apply([this, model, rest, cage, binding = *binding] {
            if (document_.model() != model || document_.state().cage != cage) {
              Q_EMIT message(tr("The cage was changed while it was bound: bind again"));
              return;
            }
            editor_.bind(binding, rest);
            Q_EMIT message(tr("Bound. Drag vertices of the cage, and the model follows"));
          });
        });
}

void Session::refine() {
  editor_.refine();
}

// ---- Keeping

bool Session::modified() const {
  return modified_ || !editor_.undo_stack().isClean();
}

QString Session::title() const {
  if (!project_path_.empty()) {
    return name_of(project_path_);
  }
  return document_.has_model() ? name_of(document_.model()->path) : QString();
}

Project Session::project() const {
  Project project;
  if (document_.has_model()) {
    std::error_code error;
    project.model_path = fs::absolute(document_.model()->path, error);
    project.model_checksum = document_.model()->checksum;
  }
  project.state = document_.state();
  project.state.binding.reset();
  project.bound = document_.mode() == Mode::deform;
  project.settings = settings_;
  project.layers = document_.layers();
  project.tools = document_.tools();
  project.camera = camera_ ? camera_() : QJsonObject();
  return project;
}

bool Session::save_project(const fs::path& path) {
  if (!report(tr("Save Project"), write_project(project(), path))) {
    return false;
  }
  project_path_ = path;
  modified_ = false;
  editor_.undo_stack().setClean();
  Q_EMIT titleChanged();
  Q_EMIT opened(QString::fromStdString(path.string()));
  Q_EMIT message(tr("Saved %1").arg(name_of(path)));
  return true;
}

Status Session::autosave(const fs::path& path) {
  return write_project(project(), path);
}

bool Session::save_cage(const fs::path& path) {
  if (!document_.has_cage()) {
    Q_EMIT message(tr("There is no cage to save"));
    return false;
  }
  PolygonMesh cage = document_.cage();
  const std::span<const Vec3> shown = document_.shown_cage_positions();
  cage.positions.assign(shown.begin(), shown.end());
  if (!report(tr("Save Cage"), write_mesh(cage, path))) {
    return false;
  }
  Q_EMIT message(tr("Saved %1").arg(name_of(path)));
  return true;
}

void Session::start_export(const QString& title, std::vector<fs::path> paths,
                           std::vector<SharedPositions> poses) {
  if (document_.mode() != Mode::deform) {
    Q_EMIT failed(title, tr("Bind the model to its cage first: only then can it be deformed."));
    return;
  }
  std::vector<ModelOutput> outputs;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    outputs.push_back({std::move(paths[i]), std::move(poses[i])});
  }
  start(title,
        [this, outputs, model = document_.model(),
         rest = document_.state().rest](const Progress& progress) -> Result<Job::Apply> {
          if (Status s = export_models(*model, *rest, outputs, progress); !s) {
            return s.error();
          }
          return Job::Apply([this, outputs] {
            Q_EMIT message(outputs.size() == 1 ? tr("Wrote %1").arg(name_of(outputs.front().path))
                                               : tr("Wrote %L1 files, %2 to %3")
                                                     .arg(outputs.size())
                                                     .arg(name_of(outputs.front().path),
                                                          name_of(outputs.back().path)));
          });
        });
}

void Session::export_model(const fs::path& path) {
  start_export(tr("Export Model"), {path}, {shared(document_.shown_cage_positions())});
}

void Session::export_poses(const fs::path& path) {
  std::vector<fs::path> paths;
  std::vector<SharedPositions> poses;
  for (const Pose& pose : document_.state().poses) {
    fs::path name = with_suffix(path, "-" + pose.name);
    for (int n = 2; std::ranges::find(paths, name) != paths.end(); ++n) {
      name = with_suffix(path, QString("-%1-%2").arg(pose.name).arg(n));
    }
    paths.push_back(name);
    poses.push_back(pose.positions);
  }
  if (paths.empty()) {
    Q_EMIT failed(tr("Export Poses"), tr("There are no poses yet. Keep some in the panel Poses."));
    return;
  }
  start_export(tr("Export Poses"), std::move(paths), std::move(poses));
}

void Session::export_sequence(const fs::path& path, int step) {
  const TimeLine& line = document_.state().time_line;
  if (line.keys.empty()) {
    Q_EMIT failed(tr("Export Sequence"),
                  tr("There are no keyframes yet. Set some in the panel Time Line."));
    return;
  }
  std::vector<fs::path> paths;
  std::vector<SharedPositions> poses;
  for (int frame = line.first; frame <= line.last; frame += std::max(step, 1)) {
    paths.push_back(with_suffix(path, QString("-%1").arg(frame, 4, 10, QChar('0'))));
    poses.push_back(shared(cage_at(line, frame)));
  }
  start_export(tr("Export Sequence"), std::move(paths), std::move(poses));
}

void Session::export_weights(const fs::path& path) {
  if (!document_.has_model() || !document_.has_cage()) {
    Q_EMIT failed(tr("Export Weights"), tr("Weights need a model and a cage."));
    return;
  }
  const PolygonMesh cage =
      document_.mode() == Mode::deform ? document_.cage_rest() : document_.cage();
  start(tr("Export Weights"),
        [this, path, cage,
         model = document_.model()](const Progress& progress) -> Result<Job::Apply> {
          if (Status s = app::export_weights(*model, cage, path, progress); !s) {
            return s.error();
          }
          return Job::Apply([this, path] { Q_EMIT message(tr("Wrote %1").arg(name_of(path))); });
        });
}

} // namespace cagewright::app
