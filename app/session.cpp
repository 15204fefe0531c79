#include "app/session.h"

#include "app/document/binding.h"
#include "app/document/time_line.h"
#include "app/edit/repair_cage.h"
#include "app/jobs/freed_elsewhere.h"
#include "app/jobs/work.h"
#include <cagewright/io/write_mesh.h>

#include <QFileInfo>
#include <QRegularExpression>
#include <QSet>

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
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

/// Pieces apart are no fault here: each moves what is in it.
bool binds_well(const ValidityReport& report) {
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    if (report.counts[k] > 0 && static_cast<ViolationKind>(k) != ViolationKind::several_pieces) {
      return false;
    }
  }
  return true;
}

QString with_notes(QString text, const std::vector<FileNote>& notes) {
  for (const FileNote& note : notes) {
    text += QStringLiteral("; ") + QString::fromStdString(note.message);
  }
  return text;
}

/// Parts of the model are where they should not be: the cage may be another unit's, or elsewhere.
bool does_not_enclose(const ValidityReport& report) {
  using enum ViolationKind;
  return report.count(vertex_outside) + report.count(vertex_on_cage) + report.count(face_contact) >
         0;
}

/// Some, ascending, and there are no others: the model may have changed since they were chosen.
bool fits(const std::vector<Index>& faces, const Model& model) {
  return !faces.empty() && faces.back() < model.mesh.face_count();
}

QString what_was_written(const std::vector<fs::path>& files) {
  return files.size() == 1 ? QObject::tr("Wrote %1").arg(name_of(files.front()))
         : files.size() == 2
             ? QObject::tr("Wrote %1 and %2").arg(name_of(files.front()), name_of(files.back()))
             : QObject::tr("Wrote %L1 files, %2 to %3")
                   .arg(files.size())
                   .arg(name_of(files.front()), name_of(files.back()));
}

/// Null where it is of another model.
SharedShares fitting(const SharedShares& painted, const Model& model) {
  return painted && painted->size() == model.mesh.positions.size() ? painted : nullptr;
}

/// Of more vertices, which have nothing.
SharedDensity with_more(const SharedDensity& painted, std::size_t count) {
  if (!painted) {
    return nullptr;
  }
  std::vector<float> more = *painted;
  more.resize(count, 0.0F);
  return std::make_shared<const std::vector<float>>(std::move(more));
}

SharedPositions shared(std::span<const Vec3> positions) {
  return std::make_shared<const std::vector<Vec3>>(positions.begin(), positions.end());
}

} // namespace

QString as_sentence(const QString& text) {
  return text.left(1).toUpper() + text.mid(1);
}

fs::path with_suffix(const fs::path& path, const QString& suffix) {
  QString clean = suffix;
  clean.replace(QRegularExpression("[^\\w.+-]"), "_");
  return path.parent_path() /
         (path.stem().string() + clean.toStdString() + path.extension().string());
}

Session::Session(QObject* parent)
    : QObject(parent), editor_(document_), deform_loop_(document_), checker_(document_) {
  connect(&jobs_, &JobRunner::failed, this, &Session::failed);
  connect(&jobs_, &JobRunner::cancelled, this, [this](const QString& title) {
    if (under_way_ == Kind::compares && !waiting_) { // or it would begin again
      settings_.beside.clear();
      Q_EMIT settingsChanged();
    }
    Q_EMIT message(tr("%1: cancelled").arg(title));
  });
  connect(&editor_, &Editor::message, this,
          [this](const QString& text) { Q_EMIT message(as_sentence(text)); });
  connect(&jobs_, &JobRunner::finished, this, [this] {
    if (waiting_ && !jobs_.busy()) {
      Waiting next = *std::exchange(waiting_, std::nullopt);
      start(next.title, std::move(next.work), next.kind);
    } else {
      take_refused_paint_back();
      show_bound_kind();
      update_beside();
    }
  });
  connect(&document_, &Document::modeChanged, this, &Session::show_bound_kind);
  connect(&document_, &Document::mixChanged, this, &Session::follow_paint);
  connect(&document_, &Document::densityChanged, this, [this] {
    // What was painted is meant to be used.
    const bool painted = document_.state().density != nullptr;
    const bool used = settings_.density == DensitySource::painted;
    if (painted != used) {
      GenerateSettings settings = settings_;
      settings.density = painted ? DensitySource::painted : DensitySource::even;
      set_settings(settings);
    }
  });
  connect(&editor_.undo_stack(), &QUndoStack::cleanChanged, this, &Session::titleChanged);
}

Session::~Session() = default;

void Session::set_settings(const GenerateSettings& settings) {
  const bool mixes_more = !settings.mixed.isEmpty() && settings.mixed != settings_.mixed;
  settings_ = settings;
  Q_EMIT settingsChanged();
  if (mixes_more && chosen().second && document_.has_model() && !document_.state().mix) {
    Q_EMIT message(tr("%1: paint where it holds, with Paint Mix of the tool bar")
                       .arg(label_of_coordinates(settings.mixed)));
  }
  const auto& binding = document_.state().binding;
  if (binding && !chosen().is(binding->choice())) {
    bind_anew();
  } else if (binding && !jobs_.busy()) {
    update_beside();
  } else if (jobs_.busy() && under_way_ == Kind::binds_anew) { // back to what is bound
    waiting_.reset();
    jobs_.cancel();
  }
}

CoordinateChoice Session::chosen() const {
  return coordinate_choice(settings_, document_.state().mix);
}

/// By other coordinates, or elsewhere by the second of them: the cage stays as it is.
void Session::bind_anew() {
  const State& state = document_.state();
  const bool overtakes =
      jobs_.busy() && (under_way_ == Kind::binds_anew || under_way_ == Kind::compares);
  if (jobs_.busy() && !overtakes) {
    Q_EMIT message(tr("Wait for \"%1\" to end, or cancel it").arg(jobs_.title()));
    return; // what is bound is shown when that has ended
  }
  const CoordinateChoice choice = chosen();
  const CoordinateChoice& bound = state.binding->choice();
  const bool is_painted = choice.has_kinds_of(bound); // else the kinds are others
  PreparedKinds kinds;
  if (is_painted) {
    kinds = state.binding->kinds();
  }
  Job::Work work = [this, caged = document_.caged(), rest = state.rest, before = state.binding,
                    choice, is_painted, kinds](const Progress& progress) -> Result<Job::Apply> {
    Result<std::shared_ptr<const Binding>> binding =
        bind_model(caged, *rest, choice, progress, kinds);
    if (!binding) {
      return binding.error();
    }
    return Job::Apply([this, before, is_painted, binding = *binding] {
      if (document_.state().binding != before) {
        return;
      }
      if (is_painted) {
        unbound_mix_.reset();
        editor_.renew_binding(binding);
        Q_EMIT message(tr("The model follows what is painted now"));
      } else {
        editor_.bind_anew(binding);
        Q_EMIT message(tr("The model follows by other coordinates now"));
      }
    });
  };
  unbound_mix_ = is_painted ? std::optional(choice.shares) : std::nullopt;
  if (overtakes) { // of a number that is changed step by step the last one counts
    waiting_.emplace(Waiting{tr("Bind"), std::move(work), Kind::binds_anew});
    jobs_.cancel();
  } else {
    start(tr("Bind"), std::move(work), Kind::binds_anew);
  }
}

/// The coordinates to compare with, once nothing else is to be done.
void Session::update_beside() {
  const State& state = document_.state();
  const CoordinateKind* kind = find_coordinate_kind(settings_.beside.toStdString());
  if (!state.binding || kind == nullptr) {
    document_.set_beside(nullptr);
    return;
  }
  GenerateSettings wanted = settings_;
  wanted.coordinates = settings_.beside;
  wanted.mixed.clear();
  const CoordinateChoice chosen = coordinate_choice(wanted);
  if (document_.beside() && document_.beside()->choice().is(chosen)) {
    return;
  }
  start(
      tr("Compare"),
      [this, caged = document_.caged(), rest = state.rest,
       chosen](const Progress& progress) -> Result<Job::Apply> {
        Result<std::shared_ptr<const Binding>> binding = bind_model(caged, *rest, chosen, progress);
        if (!binding && binding.error().code == ErrorCode::cancelled) {
          return binding.error();
        }
        return Job::Apply([this, rest, binding] {
          if (!binding) { // not again and again
            settings_.beside.clear();
            Q_EMIT settingsChanged();
            Q_EMIT failed(tr("Compare"), QString::fromStdString(binding.error().message));
          } else if (document_.state().binding && document_.state().rest == rest) {
            document_.set_beside(*binding);
          }
        });
      },
      Kind::compares);
}

/// What is bound says by which kinds: after undo, and where others were refused. What is painted
/// says where, and it is bound anew.
void Session::show_bound_kind() {
  const auto& binding = document_.state().binding;
  const bool paints_on = jobs_.busy() && under_way_ == Kind::binds_anew;
  if (!binding || (jobs_.busy() && !paints_on)) {
    return; // again when that has ended
  }
  const CoordinateChoice choice = chosen();
  if (!choice.has_kinds_of(binding->choice())) {
    if (!jobs_.busy()) {
      take_coordinates(binding->choice(), settings_);
      Q_EMIT settingsChanged();
    }
  } else if (!choice.is(binding->choice())) {
    bind_anew();
  }
}

/// Bound anew where something is painted, or was taken back.
void Session::follow_paint() {
  const auto& binding = document_.state().binding;
  if (binding && jobs_.busy() && under_way_ == Kind::binds_anew && chosen().is(binding->choice())) {
    waiting_.reset(); // what is painted is bound already
    jobs_.cancel();
  } else {
    if (document_.state().mix && !chosen().second && !jobs_.busy()) {
      Q_EMIT editor_.message(tr("painted. By which kind does it follow? Choose it in the panel "
                                "Make a Cage: Where painted"));
    }
    show_bound_kind();
  }
}

/// What could not be bound, or was cancelled, is not tried again and again.
void Session::take_refused_paint_back() {
  const std::optional<SharedShares> refused = std::exchange(unbound_mix_, std::nullopt);
  const auto& binding = document_.state().binding;
  if (refused && binding && chosen().has_kinds_of(binding->choice()) &&
      document_.state().mix == *refused && !chosen().is(binding->choice())) {
    editor_.set_mix(binding->choice().shares, tr("Take Paint Back"));
  }
}

bool Session::start(const QString& title, Job::Work work, Kind kind) {
  if (jobs_.run(title, std::move(work))) {
    under_way_ = kind;
    return true;
  }
  Q_EMIT message(tr("Wait for \"%1\" to end, or cancel it").arg(jobs_.title()));
  return false;
}

void Session::start_next(const QString& title, Job::Work work) {
  if (!jobs_.busy()) {
    start(title, std::move(work));
    return;
  }
  waiting_.emplace(Waiting{title, std::move(work), Kind::replaceable});
  if (under_way_ == Kind::writes) {
    Q_EMIT message(tr("%1: comes next, when \"%2\" is done").arg(title, jobs_.title()));
  } else {
    Q_EMIT message(tr("%1: comes next, \"%2\" is being cancelled").arg(title, jobs_.title()));
    jobs_.cancel();
  }
}

bool Session::may_replace_cage(const QString& title, const QString& go_on) {
  const State& state = document_.state();
  const std::size_t poses = state.poses.size();
  const std::size_t keys = state.time_line.keys.size();
  QStringList lost;
  if (editor_.deformation_is_unkept()) {
    lost.append(tr("the deformation of the model"));
  }
  if (poses > 0) {
    lost.append(poses == 1 ? tr("a pose") : tr("%1 poses").arg(poses));
  }
  if (keys > 0) {
    lost.append(keys == 1 ? tr("a keyframe") : tr("%1 keyframes").arg(keys));
  }
  return !ask_ || lost.empty() ||
         ask_({title,
               tr("Another cage has other vertices. What was made with the present one does not "
                  "fit it and is removed: %1. Undo brings it back.")
                   .arg(lost.join(tr(", "))),
               go_on});
}

bool Session::report(const QString& title, const Status& status) {
  if (!status) {
    Q_EMIT failed(title, QString::fromStdString(status.error().message));
  }
  return status.has_value();
}

// ---- Opening

void Session::open(const fs::path& path, const fs::path& cage, Then then) {
  if (is_project(path)) {
    open_project(path, {}, false);
    return;
  }
  start_next(tr("Open"), [this, path, cage, then](const Progress& progress) -> Result<Job::Apply> {
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
    return Job::Apply([this, path, then, model = *model, mesh] {
      document_.set_model(freed_elsewhere(model));
      if (mesh) {
        editor_.replace_cage(mesh, nullptr, tr("Load Cage"));
      }
      editor_.undo_stack().clear();
      project_path_.clear();
      modified_ = false;
      Q_EMIT titleChanged();
      Q_EMIT cameraRestored({});
      Q_EMIT opened(QString::fromStdString(path.string()));
      Q_EMIT message(with_notes(tr("%1: %L2 vertices, %L3 triangles")
                                    .arg(name_of(path))
                                    .arg(model->mesh.positions.size())
                                    .arg(model->triangles.size()),
                                model->notes));
      go_on(then);
    });
  });
}

void Session::add_model(const fs::path& path) {
  if (!document_.has_model() || document_.model()->path.empty()) {
    open(path);
    return;
  }
  std::vector<fs::path> paths;
  for (const ModelPart& part : document_.model()->parts) {
    paths.push_back(part.origin.path);
  }
  paths.push_back(path);
  start_next(
      tr("Add Model"),
      [this, paths, before = document_.model()](const Progress& progress) -> Result<Job::Apply> {
        Result<std::shared_ptr<const Model>> model = open_models(paths, progress);
        if (!model) {
          return model.error();
        }
        return Job::Apply([this, paths, before, model = *model] {
          if (document_.model() != before) {
            return; // another one was opened meanwhile
          }
          editor_.refine();
          State state = document_.state();
          state.density = with_more(state.density, model->mesh.positions.size());
          state.mix = with_more(state.mix, model->mesh.positions.size());
          state.stages.reset();
          document_.set_model(freed_elsewhere(model));
          document_.set_state(state);
          editor_.undo_stack().clear();
          modified_ = true;
          Q_EMIT titleChanged();
          Q_EMIT message(tr("%1 was added: %L2 vertices together")
                             .arg(name_of(paths.back()))
                             .arg(model->mesh.positions.size()));
        });
      });
}

void Session::load_cage(const fs::path& path) {
  if (!may_replace_cage(tr("Load Cage"), tr("Load It"))) {
    return;
  }
  start_next(tr("Load Cage"), [this, path](const Progress&) -> Result<Job::Apply> {
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
  start_next(
      tr("Open Project"),
      [this, path, recovered, project = *read](const Progress& progress) -> Result<Job::Apply> {
        std::shared_ptr<const Model> model;
        std::shared_ptr<const Binding> binding;
        if (!project.model_path.empty()) {
          std::vector<fs::path> paths = {project.model_path};
          paths.insert(paths.end(), project.more_models.begin(), project.more_models.end());
          Result<std::shared_ptr<const Model>> opened = open_models(paths, progress.part(0, 0.4));
          if (!opened) {
            return opened.error();
          }
          model = *opened;
        }
        std::shared_ptr<const Region> region;
        if (model && fits(project.region_faces, *model)) {
          Result<std::shared_ptr<const Region>> made =
              make_region(*model, project.region_faces, project.region_name);
          if (!made) {
            return made.error();
          }
          region = *made;
        }
        if (project.bound && model) {
          Result<std::shared_ptr<const Binding>> bound =
              bind_model({model, region}, *project.state.rest,
                         coordinate_choice(project.settings, fitting(project.state.mix, *model)),
                         progress.part(0.4, 1));
          if (!bound) {
            return bound.error();
          }
          binding = *bound;
        }
        return Job::Apply([this, path, recovered, project, model, region, binding] {
          restore(project, model, region, binding);
          project_path_ = recovered ? project.saved_as : path;
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
          if (!project.notes.empty()) {
            QStringList notes;
            for (const std::string& note : project.notes) {
              notes.append(QString::fromStdString(note));
            }
            Q_EMIT failed(tr("Open Project"),
                          tr("%1 is open, but not all that its file says can be used:\n%2\nThe "
                             "usual is used instead.")
                              .arg(name_of(path), notes.join("\n")));
          }
        });
      });
}

void Session::restore(const Project& project, std::shared_ptr<const Model> model,
                      std::shared_ptr<const Region> region,
                      std::shared_ptr<const Binding> binding) {
  document_.set_model(freed_elsewhere(std::move(model)));
  State state = project.state;
  for (SharedDensity* painted : {&state.density, &state.mix}) {
    *painted = document_.has_model() ? fitting(*painted, *document_.model()) : nullptr;
  }
  state.region = std::move(region);
  state.binding = std::move(binding);
  document_.set_state(state);
  if (project.frame && document_.mode() == Mode::deform) {
    document_.set_time(project.frame);
    if (!project.shows_frame) { // it stands there, and shows the edited pose
      document_.set_time(std::nullopt);
    }
  }
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
  if (!may_replace_cage(tr("Generate Cage"), tr("Generate"))) {
    return;
  }
  start(tr("Generate"),
        [this, caged = document_.caged(), settings = settings_,
         painted = document_.state().density](const Progress& progress) -> Result<Job::Apply> {
          CagedModel part = caged; // what the cage is for from now on
          Progress making = progress;
          if (settings.options.ignore_specks) {
            Result<std::shared_ptr<const Region>> rest =
                region_without_specks(caged, progress.part(0, 0.05));
            if (!rest) {
              return rest.error();
            }
            part.region = *rest ? *std::move(rest) : caged.region;
            making = progress.part(0.05, 1);
          }
          Result<MadeCage> made = make_cage(part, settings, painted, making);
          if (!made) {
            return made.error();
          }
          return Job::Apply(
              [this, model = caged.shared_model(), region = part.region, made = *made] {
                if (document_.caged().shared_model() != model) {
                  return; // another one was opened or chosen meanwhile
                }
                editor_.replace_cage(made.cage, made.stages, region, tr("Generate Cage"));
                const QString what = tr("A valid cage of %L1 vertices and %L2 faces")
                                         .arg(made.cage->positions.size())
                                         .arg(made.cage->face_count());
                Q_EMIT message(made.remark.isEmpty() ? what : what + "; " + made.remark);
              });
        });
}

bool Session::can_choose_region(const QString& title) {
  if (!document_.has_model()) {
    Q_EMIT message(tr("Open a model first"));
    return false;
  }
  if (document_.mode() == Mode::deform) {
    Q_EMIT message(tr("%1: the model is bound to this cage; go back to refining first").arg(title));
    return false;
  }
  return true;
}

void Session::choose_region(const QString& name, std::vector<Index> faces) {
  const QString title = tr("Cage for a Part");
  if (!can_choose_region(title)) {
    return;
  }
  if (faces.size() == document_.model()->mesh.face_count()) {
    choose_whole_model();
    return;
  }
  start_region(title,
               [name, faces = std::move(faces),
                model = document_.model()](const Progress& progress) -> Result<ChosenRegion> {
                 Result<std::shared_ptr<const Region>> made =
                     make_region(*model, faces, name, progress);
                 return made ? Result(ChosenRegion{*std::move(made), {}}) : made.error();
               });
}

void Session::choose_outlined(ScreenOutline outline, bool takes_away) {
  const QString title = tr("Cage for a Part");
  if (!can_choose_region(title)) {
    return;
  }
  start_region(title,
               [name = tr("the painted part"), caged = document_.caged(), takes_away,
                outline = std::move(outline)](const Progress& progress) -> Result<ChosenRegion> {
                 const Model& model = *caged.whole;
                 const Result<std::vector<Index>> found =
                     outlined_faces(model.mesh, model.bvh, outline, progress.part(0, 0.5));
                 if (!found) {
                   return found.error();
                 }
                 if (found->empty()) {
                   return ChosenRegion{nullptr, tr("Nothing of the model is within the outline")};
                 }
                 std::vector<Index> faces;
                 std::vector<Index> before;
                 if (caged.region) {
                   before = caged.region->faces;
                 } else if (takes_away) { // from all of it
                   before.resize(model.mesh.face_count());
                   std::iota(before.begin(), before.end(), Index{0});
                 }
                 if (takes_away) {
                   std::ranges::set_difference(before, *found, std::back_inserter(faces));
                 } else {
                   std::ranges::set_union(before, *found, std::back_inserter(faces));
                 }
                 if (faces.size() == model.mesh.face_count()) {
                   return ChosenRegion();
                 }
                 Result<std::shared_ptr<const Region>> made =
                     make_region(model, std::move(faces), name, progress.part(0.5, 1));
                 return made ? Result(ChosenRegion{*std::move(made), {}}) : made.error();
               });
}

void Session::choose_all_but_specks() {
  const QString title = tr("Cage for All but Specks");
  if (!can_choose_region(title)) {
    return;
  }
  start_region(title,
               [whole = document_.model()](const Progress& progress) -> Result<ChosenRegion> {
                 Result<std::shared_ptr<const Region>> made =
                     region_without_specks({.whole = whole}, progress);
                 if (!made) {
                   return made.error();
                 }
                 return ChosenRegion{*made, *made ? QString()
                                                  : tr("There are no specks: no tiny piece is far "
                                                       "from the rest")};
               });
}

void Session::start_region(const QString& title, const MakeRegion& make) {
  start(title,
        [this, title, make,
         model = document_.model()](const Progress& progress) -> Result<Job::Apply> {
          Result<ChosenRegion> chosen = make(progress);
          if (!chosen) {
            return chosen.error();
          }
          return Job::Apply([this, title, model, chosen = *std::move(chosen)] {
            if (document_.model() != model || document_.mode() == Mode::deform) {
              return; // another one was opened meanwhile
            }
            if (!chosen.nothing.isEmpty()) {
              Q_EMIT message(chosen.nothing);
            } else if (!chosen.region) {
              choose_whole_model();
            } else {
              editor_.set_region(chosen.region, title);
              Q_EMIT message(tr("The cage is for %1 now: %L2 of %L3 faces")
                                 .arg(chosen.region->name)
                                 .arg(chosen.region->faces.size())
                                 .arg(model->mesh.face_count()));
            }
          });
        });
}

void Session::choose_whole_model() {
  if (document_.mode() == Mode::refine && document_.state().region) {
    editor_.set_region(nullptr, tr("Cage for the Whole Model"));
  }
}

void Session::make_stages() {
  if (!document_.has_model()) {
    Q_EMIT message(tr("Open a model first"));
    return;
  }
  start(tr("Split"),
        [this, model = document_.caged().shared_model(),
         settings = settings_](const Progress& progress) -> Result<Job::Apply> {
          Result<std::shared_ptr<const BoxDecomposition>> stages =
              app::make_stages(*model, settings, progress);
          if (!stages) {
            return stages.error();
          }
          return Job::Apply([this, model, stages = *stages] {
            if (document_.caged().shared_model() == model) {
              document_.set_stages(stages);
            }
          });
        });
}

void Session::bind(Doubts doubts) {
  if (!document_.has_model() || !document_.has_cage() || document_.mode() == Mode::deform) {
    Q_EMIT message(tr("Binding needs a model and a cage"));
    return;
  }
  auto rest = std::make_shared<const PolygonMesh>(document_.cage());
  const CageCheck& check = document_.check();
  const bool known = check.state == CageCheck::State::done && check.report &&
                     check.report->valid() && !checker_.busy();
  const bool judges = doubts == Doubts::tell && !known;
  start(tr("Bind"),
        [this, judges, caged = document_.caged(), rest, cage = document_.state().cage,
         kind = chosen()](const Progress& whole) -> Result<Job::Apply> {
          if (judges) {
            const Model& model = caged.model();
            Result<JudgedCage> judged = judge_cage(*rest, &model, whole.part(0, 0.3));
            if (!judged) {
              return judged.error();
            }
            if (!binds_well(*judged->report)) {
              BindingDoubts found{judged->report, {}};
              if (does_not_enclose(*judged->report)) {
                found.fit = fit_cage(*rest, model.view());
              }
              return Job::Apply([this, found] {
                // Not before the job has ended: what is answered may start another.
                QMetaObject::invokeMethod(
                    this, [this, found] { Q_EMIT bindingDoubtful(found); }, Qt::QueuedConnection);
              });
            }
          }
          const Progress progress = whole.part(judges ? 0.3 : 0, 1);
          Result<std::shared_ptr<const Binding>> binding = bind_model(caged, *rest, kind, progress);
          if (!binding) {
            return binding.error();
          }
          return Job::Apply([this, model = caged.shared_model(), rest, cage, binding = *binding] {
            if (document_.caged().shared_model() != model || document_.state().cage != cage) {
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

void Session::switch_mode() {
  if (document_.mode() == Mode::deform) {
    refine();
  } else {
    bind();
  }
}

bool Session::can_repair(const QString& title) {
  if (document_.has_cage() && document_.mode() == Mode::refine) {
    return true;
  }
  Q_EMIT message(
      document_.has_cage()
          ? tr("%1: the model is bound to this cage; go back to refining first").arg(title)
          : tr("%1: there is no cage yet").arg(title));
  return false;
}

void Session::go_on(Then then) {
  if (then == Then::bind) {
    // Not before a job that has led here has ended.
    QMetaObject::invokeMethod(
        this, [this] { bind(); }, Qt::QueuedConnection);
  }
}

void Session::fit_cage_to_model(Then then) {
  const QString title = tr("Fit Cage to Model");
  if (!can_repair(title)) {
    return;
  }
  if (!document_.has_model()) {
    Q_EMIT message(tr("%1: there is no model yet").arg(title));
    return;
  }
  const auto rest = std::make_shared<const PolygonMesh>(document_.cage());
  start(title,
        [this, title, then, rest, cage = document_.state().cage,
         model = document_.caged().shared_model()](const Progress&) -> Result<Job::Apply> {
          const std::optional<CageFit> fit = fit_cage(*rest, model->view());
          return Job::Apply([this, title, then, rest, cage, model, fit] {
            if (document_.caged().shared_model() != model || document_.state().cage != cage) {
              return; // another one meanwhile
            }
            if (!fit) {
              Q_EMIT message(
                  tr("%1: no scale, turn or shift would make this cage fit better").arg(title));
              return;
            }
            editor_.adjust_cage(std::make_shared<const PolygonMesh>((*fit)(*rest)), *fit, title);
            Q_EMIT message(tr("The cage is %1").arg(QString::fromStdString(fit->description)));
            go_on(then);
          });
        });
}

void Session::weld_cage(Then then) {
  const QString title = tr("Weld Cage");
  if (!can_repair(title)) {
    return;
  }
  // Near enough to be one vertex, and far less than a cage has between two.
  constexpr double tolerance = 1e-4;
  const PolygonMesh before = document_.cage();
  PolygonMesh welded = welded_cage(before, tolerance * document_.diagonal());
  if (welded.positions.size() == before.positions.size()) {
    Q_EMIT message(tr("%1: no vertices are in one place").arg(title));
  } else {
    const std::size_t gone = before.positions.size() - welded.positions.size();
    editor_.replace_cage(std::make_shared<const PolygonMesh>(std::move(welded)), nullptr, title);
    Q_EMIT message(tr("%L1 vertices fewer").arg(gone));
  }
  go_on(then);
}

void Session::turn_cage_outward(Then then) {
  const QString title = tr("Turn Cage Inside Out");
  if (!can_repair(title)) {
    return;
  }
  const PolygonMesh before = document_.cage();
  PolygonMesh turned = turned_outward(before);
  if (std::ranges::equal(turned.corners(), before.corners())) {
    Q_EMIT message(tr("%1: all faces look outward").arg(title));
  } else {
    editor_.adjust_cage(std::make_shared<const PolygonMesh>(std::move(turned)), std::identity(),
                        title);
  }
  go_on(then);
}

// ---- Keeping

bool Session::modified() const {
  return modified_ || !editor_.undo_stack().isClean();
}

QString Session::title() const {
  if (!project_path_.empty()) {
    return name_of(project_path_);
  }
  if (!document_.has_model()) {
    return {};
  }
  const std::size_t more = document_.model()->parts.size() - 1;
  const QString first = name_of(document_.model()->path);
  return more == 0 ? first : tr("%1 and %2 more").arg(first).arg(more);
}

Project Session::project() const {
  Project project;
  if (document_.has_model()) {
    std::error_code error;
    project.model_path = fs::absolute(document_.model()->path, error);
    project.model_checksum = document_.model()->checksum;
    const std::vector<ModelPart>& parts = document_.model()->parts;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      project.more_models.push_back(fs::absolute(parts[i].origin.path, error));
    }
  }
  project.state = document_.state();
  project.state.binding.reset();
  project.bound = document_.mode() == Mode::deform;
  project.settings = settings_;
  project.layers = document_.layers();
  project.tools = document_.tools();
  project.camera = camera_ ? camera_() : QJsonObject();
  if (project.bound) {
    project.frame = document_.frame();
    project.shows_frame = document_.time().has_value();
  }
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
  Project kept = project();
  kept.saved_as = project_path_;
  return write_project(kept, path);
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

std::vector<fs::path> Session::files_of_parts(const std::vector<fs::path>& paths) const {
  std::vector<fs::path> files;
  for (const fs::path& path : paths) {
    for (std::size_t part = 0; part < document_.model()->parts.size(); ++part) {
      files.push_back(path_of_part(*document_.model(), part, path));
    }
  }
  return files;
}

bool Session::may_replace_files(const QString& title, const fs::path& chosen,
                                const std::vector<fs::path>& files) {
  std::vector<fs::path> there;
  std::ranges::copy_if(files, std::back_inserter(there), [&](const fs::path& file) {
    std::error_code ignored;
    return file != chosen && fs::exists(file, ignored);
  });
  return there.empty() || !ask_ ||
         ask_({title,
               there.size() == 1 ? tr("%1 is there already.").arg(name_of(there.front()))
                                 : tr("%L1 of the files are there already, %2 to %3.")
                                       .arg(there.size())
                                       .arg(name_of(there.front()), name_of(there.back())),
               there.size() == 1 ? tr("Replace It") : tr("Replace Them")});
}

void Session::start_export(const QString& title, const fs::path& chosen,
                           std::vector<fs::path> paths, std::vector<SharedPositions> poses) {
  if (document_.mode() != Mode::deform) {
    Q_EMIT failed(title, tr("Bind the model to its cage first: only then can it be deformed."));
    return;
  }
  const std::vector<fs::path> files = files_of_parts(paths);
  if (!may_replace_files(title, chosen, files)) {
    return;
  }
  std::vector<ModelOutput> outputs;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    outputs.push_back({std::move(paths[i]), std::move(poses[i])});
  }
  start(
      title,
      [this, files, outputs, caged = document_.caged(),
       binding = document_.state().binding](const Progress& progress) -> Result<Job::Apply> {
        Result<std::vector<FileNote>> notes =
            export_models(caged, binding->coordinates(), outputs, progress);
        if (!notes) {
          return notes.error();
        }
        return Job::Apply([this, files, notes = *std::move(notes)] {
          Q_EMIT message(with_notes(what_was_written(files), notes));
        });
      },
      Kind::writes);
}

void Session::export_model(const fs::path& path) {
  start_export(tr("Export Model"), path, {path}, {shared(document_.shown_cage_positions())});
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
  start_export(tr("Export Poses"), path, std::move(paths), std::move(poses));
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
  start_export(tr("Export Sequence"), path, std::move(paths), std::move(poses));
}

void Session::export_animation(const fs::path& path) {
  const QString title = tr("Export Animation");
  if (document_.mode() != Mode::deform || document_.state().time_line.keys.empty()) {
    Q_EMIT failed(title, tr("There are no keyframes yet. Set some in the panel Time Line."));
    return;
  }
  const std::vector<fs::path> files = files_of_parts({path});
  if (!may_replace_files(title, path, files)) {
    return;
  }
  start(
      title,
      [this, path, files, caged = document_.caged(), binding = document_.state().binding,
       line = document_.state().time_line](const Progress& progress) -> Result<Job::Apply> {
        if (Status s = app::export_animation(caged, binding->coordinates(), line, path, progress);
            !s) {
          return s.error();
        }
        return Job::Apply([this, files] { Q_EMIT message(what_was_written(files)); });
      },
      Kind::writes);
}

void Session::export_weights(const fs::path& path) {
  if (!document_.has_model() || !document_.has_cage()) {
    Q_EMIT failed(tr("Export Weights"), tr("Weights need a model and a cage."));
    return;
  }
  const bool bound = document_.mode() == Mode::deform;
  const PolygonMesh cage = bound ? document_.cage_rest() : document_.cage();
  start(
      tr("Export Weights"),
      [this, path, cage, choice = bound ? document_.state().binding->choice() : chosen(),
       caged = document_.caged()](const Progress& progress) -> Result<Job::Apply> {
        if (Status s = app::export_weights(caged, cage, choice, path, progress); !s) {
          return s.error();
        }
        return Job::Apply([this, path] { Q_EMIT message(tr("Wrote %1").arg(name_of(path))); });
      },
      Kind::writes);
}

void Session::export_mix(const fs::path& path) {
  const QString title = tr("Export Mix Weights");
  if (!document_.state().mix) {
    Q_EMIT failed(title, tr("Nothing is painted yet. Paint where another kind of coordinates "
                            "holds, with Paint Mix of the tool bar."));
    return;
  }
  const std::vector<fs::path> files = files_of_parts({path});
  if (!may_replace_files(title, path, files)) {
    return;
  }
  start(
      title,
      [this, path, files, model = document_.model(),
       mix = document_.state().mix](const Progress&) -> Result<Job::Apply> {
        if (Status s = app::export_mix(*model, mix, path); !s) {
          return s.error();
        }
        return Job::Apply([this, files] { Q_EMIT message(what_was_written(files)); });
      },
      Kind::writes);
}

} // namespace cagewright::app
