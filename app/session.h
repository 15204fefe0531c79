/// \file
/// What the menus and buttons do, without any widget.
#pragma once

#include "app/commands/editor.h"
#include "app/document/document.h"
#include "app/document/generate_settings.h"
#include "app/document/project_file.h"
#include "app/edit/outlined_faces.h"
#include "app/jobs/checker.h"
#include "app/jobs/deform_loop.h"
#include "app/jobs/job_runner.h"
#include <cagewright/validate/fit.h>

#include <QObject>
#include <QString>

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace cagewright::app {

/// Something to be decided before work goes on.
struct Question {
  QString title;
  QString text;
  QString go_on; ///< what the button says; the other one cancels
};

/// Why a cage is not bound at once.
struct BindingDoubts {
  std::shared_ptr<const ValidityReport> report;
  std::optional<CageFit> fit; ///< what would make the cage fit as a whole
};

/// One document and all that works on it. What takes time runs as a job and leaves the window
/// usable; a failure becomes a sentence for failed(), never more.
class Session final : public QObject {
  Q_OBJECT

public:
  explicit Session(QObject* parent = nullptr);
  ~Session() override;

  [[nodiscard]] Document& document() { return document_; }
  [[nodiscard]] Editor& editor() { return editor_; }
  [[nodiscard]] JobRunner& jobs() { return jobs_; }
  [[nodiscard]] Checker& checker() { return checker_; }
  [[nodiscard]] DeformLoop& deform_loop() { return deform_loop_; }

  [[nodiscard]] const GenerateSettings& settings() const { return settings_; }
  void set_settings(const GenerateSettings& settings);

  // ---- Opening. Each replaces what is open; asking whether to keep that is up to the window.

  enum class Then { stay, bind };
  /// A project, or a model and perhaps a cage for it, to which it may be bound at once.
  void open(const std::filesystem::path& path, const std::filesystem::path& cage = {},
            Then then = Then::stay);
  /// A cage for the model that is open.
  void load_cage(const std::filesystem::path& path);
  /// Another model beside the one that is open, under the same cage. What is bound is unbound.
  void add_model(const std::filesystem::path& path);
  /// Another place for the project's model that was not found.
  void open_project_with_model(const std::filesystem::path& project,
                               const std::filesystem::path& model);

  // ---- Working

  /// Who is asked before something goes that took work to make; nobody: it goes on.
  void set_asker(std::function<bool(const Question&)> ask) { ask_ = std::move(ask); }

  void generate();
  /// The cage is for these faces of the model alone, ascending; the rest stays where it is.
  void choose_region(const QString& name, std::vector<Index> faces);
  void choose_whole_model();
  /// The faces within an outline besides, or no more.
  void choose_outlined(ScreenOutline outline, bool takes_away);
  /// The cage is for all but tiny pieces far from the rest; says so if there are none.
  void choose_all_but_specks();
  /// Splits the model into boxes, to look at.
  void make_stages();
  enum class Doubts { tell, ignore };
  /// Judges the cage first: unless doubts are ignored, one that is not valid becomes
  /// bindingDoubtful(), and nothing is bound.
  void bind(Doubts doubts = Doubts::tell);
  void refine();
  /// Refine mode becomes deform mode, and back.
  void switch_mode();

  /// What makes a cage from elsewhere fit; in refine mode. Each says so if there is nothing to do.
  /// Scales, turns and shifts the cage as a whole: see fit_cage().
  void fit_cage_to_model(Then then = Then::stay);
  /// Makes vertices that are very near to each other on open edges one.
  void weld_cage(Then then = Then::stay);
  /// Turns all faces outward.
  void turn_cage_outward(Then then = Then::stay);
  void cancel() { jobs_.cancel(); }

  // ---- Keeping

  /// Of the project; empty: not saved yet.
  [[nodiscard]] const std::filesystem::path& project_path() const { return project_path_; }
  [[nodiscard]] bool modified() const;
  /// The title of what is open: the project's or the model's name, or empty.
  [[nodiscard]] QString title() const;
  bool save_project(const std::filesystem::path& path);
  /// The same as a file from which a later run can go on after a crash; does not count as saved.
  Status autosave(const std::filesystem::path& path);
  /// Goes on from an autosaved project; it counts as modified.
  void recover(const std::filesystem::path& path);
  /// Where the camera comes from when a project is saved.
  void set_camera_source(std::function<QJsonObject()> source) { camera_ = std::move(source); }

  bool save_cage(const std::filesystem::path& path);
  void export_model(const std::filesystem::path& path);
  /// A file for each pose: PATH's name with "-NAME" after its stem.
  void export_poses(const std::filesystem::path& path);
  /// A file for each frame of the time line, every `step` frames: "-0001" and so on.
  void export_sequence(const std::filesystem::path& path, int step);
  /// The time line as one file that moves: .glb, .pc2 or .mdd.
  void export_animation(const std::filesystem::path& path);
  void export_weights(const std::filesystem::path& path);
  /// What is painted for another kind of coordinates: numbers for `cagewright bind --mix-weights`.
  void export_mix(const std::filesystem::path& path);

Q_SIGNALS:
  void message(const QString& text); ///< for the status bar
  void failed(const QString& title, const QString& text);
  void opened(const QString& path); ///< for the list of recent files
  void titleChanged();              ///< title() or modified()
  void settingsChanged();
  void cameraRestored(const QJsonObject& camera);
  /// The model of a project is not where it was, or is another one.
  void modelMissing(const QString& project, const QString& model);
  /// The cage is not a valid one of the model, or not at all: ask, and bind() again.
  void bindingDoubtful(const cagewright::app::BindingDoubts& doubts);

private:
  [[nodiscard]] Project project() const;
  void open_project(const std::filesystem::path& path, const std::filesystem::path& model,
                    bool recovered);
  void restore(const Project& project, std::shared_ptr<const Model> model,
               std::shared_ptr<const Region> region, std::shared_ptr<const Binding> binding);
  /// \param chosen  the path that was asked for, of which those of the files are made
  void start_export(const QString& title, const std::filesystem::path& chosen,
                    std::vector<std::filesystem::path> paths, std::vector<SharedPositions> poses);
  /// What is written where these paths are asked for: a file for each part of the model.
  [[nodiscard]] std::vector<std::filesystem::path>
  files_of_parts(const std::vector<std::filesystem::path>& paths) const;
  /// Asks whether files may be replaced, besides the one that was chosen.
  [[nodiscard]] bool may_replace_files(const QString& title, const std::filesystem::path& chosen,
                                       const std::vector<std::filesystem::path>& files);
  enum class Kind { replaceable, writes, binds_anew, compares };
  bool start(const QString& title, Job::Work work, Kind kind = Kind::replaceable);
  /// The same, but what is under way makes room: it is cancelled, or, where it writes files, ended
  /// first.
  void start_next(const QString& title, Job::Work work);
  /// Asks whether poses and deformations that only fit the present cage may go.
  [[nodiscard]] bool may_replace_cage(const QString& title, const QString& go_on);
  bool report(const QString& title, const Status& status);
  /// Whether what the cage is for can be chosen; says why not.
  bool can_choose_region(const QString& title);
  struct ChosenRegion {
    std::shared_ptr<const Region> region; ///< null: the whole model
    QString nothing;                      ///< why nothing changes; empty: it does
  };
  using MakeRegion = std::function<Result<ChosenRegion>(const Progress&)>;
  void start_region(const QString& title, const MakeRegion& make);
  /// Whether the cage can be changed as a whole; says why not.
  bool can_repair(const QString& title);
  void go_on(Then then);
  /// By which coordinates the model is to follow, as it is set and painted.
  [[nodiscard]] CoordinateChoice chosen() const;
  void bind_anew();
  void follow_paint();
  void take_refused_paint_back();
  void show_bound_kind();
  void update_beside();

  Document document_;
  Editor editor_;
  JobRunner jobs_;
  DeformLoop deform_loop_;
  Checker checker_;
  GenerateSettings settings_;
  std::filesystem::path project_path_;
  bool modified_ = false; // what the undo stack does not know: recovered work
  std::function<QJsonObject()> camera_;
  std::function<bool(const Question&)> ask_;
  Kind under_way_ = Kind::replaceable;
  struct Waiting {
    QString title;
    Job::Work work;
    Kind kind;
  };
  std::optional<Waiting> waiting_;          // for the job under way to end
  std::optional<SharedShares> unbound_mix_; // painted, and being bound
};

/// PATH with something between stem and extension: "a/b.obj", "-01" gives "a/b-01.obj". What files
/// cannot be named is replaced.
std::filesystem::path with_suffix(const std::filesystem::path& path, const QString& suffix);

/// Refusals come as parts of sentences, in lower case.
QString as_sentence(const QString& text);

} // namespace cagewright::app
