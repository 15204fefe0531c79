#include "app/session.h"

#include "app/document/binding.h"
#include "app/recovery.h"
#include "mesh/shapes.h"
#include "waiting.h"
#include <cagewright/deform/weights_file.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/write_mesh.h>

#include <QFile>
#include <QTemporaryDir>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <variant>

namespace cagewright::app {
namespace {

namespace fs = std::filesystem;
using test::wait_until;

/// A session with a torus to open and a cage for it, both as files.
class SessionTest : public testing::Test {
protected:
  void SetUp() override {
    ASSERT_TRUE(write_mesh(PolygonMesh(make_torus(0.25, 40, 20)), path("model.obj")));
    ASSERT_TRUE(write_mesh(PolygonMesh(make_torus(0.4, 12, 7)), path("cage.obj")));
    QObject::connect(&session_, &Session::failed, [this](const QString&, const QString& text) {
      failures_.push_back(text.toStdString());
    });
    QObject::connect(&session_, &Session::message,
                     [this](const QString& text) { message_ = text.toStdString(); });
  }

  fs::path path(const std::string& name) { return fs::path(folder_.path().toStdString()) / name; }
  void wait() {
    ASSERT_TRUE(wait_until([this] { return !session_.jobs().busy(); }));
  }
  void open_and_bind() {
    session_.open(path("model.obj"), path("cage.obj"));
    wait();
    ASSERT_TRUE(session_.document().has_cage());
    session_.bind();
    wait();
    ASSERT_EQ(session_.document().mode(), Mode::deform);
  }
  void drag(Index vertex, const Vec3& by) {
    session_.editor().move({vertex}, std::vector<Vec3>{cage()[vertex] + by}, "Move");
  }
  std::vector<Vec3> cage() {
    const auto positions = session_.document().cage_positions();
    return {positions.begin(), positions.end()};
  }
  std::vector<Vec3> shown_model() {
    session_.deform_loop().finish();
    const auto positions = session_.document().model_positions();
    return {positions.begin(), positions.end()};
  }

  QTemporaryDir folder_;
  std::vector<std::string> failures_;
  std::string message_;
  Session session_;
};

double greatest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  double greatest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    greatest = std::max(greatest, (a[i] - b[i]).norm());
  }
  return greatest;
}

TEST_F(SessionTest, MakesACageThatTheCheckCallsValid) {
  session_.open(path("model.obj"));
  wait();
  GenerateSettings settings;
  settings.options.vertices = 40;
  session_.set_settings(settings);
  session_.generate();
  EXPECT_FALSE(session_.document().has_cage()) << "the cage comes when it is ready";
  wait();
  ASSERT_TRUE(session_.document().has_cage());
  EXPECT_LE(session_.document().cage_rest().positions.size(), 40U);
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  ASSERT_TRUE(session_.document().check().report);
  EXPECT_TRUE(session_.document().check().report->valid());
  ASSERT_TRUE(session_.document().metrics());
  EXPECT_GT(session_.document().metrics()->volume_ratio, 1);
  session_.editor().undo_stack().undo();
  EXPECT_FALSE(session_.document().has_cage());
}

TEST_F(SessionTest, FollowsByTheNumbersOfTheKindAsTheyAreChanged) {
  open_and_bind();
  drag(3, {0.3, 0, 0});
  GenerateSettings settings = session_.settings();
  settings.coordinates = "somigliana";
  session_.set_settings(settings);
  wait();
  const std::vector<Vec3> before = shown_model();
  const auto bound = [this]() -> const CoordinateSettings& {
    return session_.document().state().binding->settings();
  };
  ASSERT_EQ(bound().kind().name, "somigliana");
  for (const double bulge : {0.5, 1.0, 2.0}) { // faster than it binds: the last one counts
    settings.coordinate_numbers["bulge"] = bulge;
    session_.set_settings(settings);
  }
  ASSERT_TRUE(wait_until([this, &bound] {
    return !session_.jobs().busy() && bound().text().find("bulge=2") != std::string::npos;
  })) << bound().text();
  EXPECT_GT(greatest_distance(shown_model(), before), 1e-6);
  session_.editor().undo_stack().undo();
  EXPECT_EQ(session_.settings().coordinate_numbers.at("bulge"), 0) << "the panel says what is so";
  EXPECT_LT(greatest_distance(shown_model(), before), 1e-12);
  // And they are kept with the project.
  session_.editor().undo_stack().redo();
  ASSERT_TRUE(session_.save_project(path("bulge.cagewright")));
  session_.open(path("bulge.cagewright"));
  wait();
  EXPECT_NE(bound().text().find("bulge=2"), std::string::npos) << bound().text();
}

TEST_F(SessionTest, ShowsTheSamePoseByOtherCoordinatesBesideTheModel) {
  open_and_bind();
  drag(3, {0.3, 0, 0});
  const Document& document = session_.document();
  GenerateSettings settings = session_.settings();
  settings.beside = "green";
  session_.set_settings(settings);
  wait();
  session_.deform_loop().finish();
  ASSERT_TRUE(document.deformed_beside());
  const std::vector<Vec3> of_model = shown_model();
  const std::vector<Vec3> of_other = document.deformed_beside()->positions;
  EXPECT_GT(greatest_distance(of_other, of_model), 1e-4);
  // It is what the model would be.
  settings.coordinates = "green";
  settings.beside.clear();
  session_.set_settings(settings);
  wait();
  EXPECT_LT(greatest_distance(shown_model(), of_other), 1e-9);
  EXPECT_FALSE(document.deformed_beside());
  // Back and forth between cage and pose it comes and goes.
  settings.coordinates = "mean_value";
  settings.beside = "green";
  session_.set_settings(settings);
  wait();
  session_.deform_loop().finish();
  EXPECT_TRUE(document.beside());
  session_.refine();
  EXPECT_FALSE(document.beside());
  session_.bind();
  wait();
  ASSERT_TRUE(wait_until([&] { return document.deformed_beside() != nullptr; }));
  drag(3, {0, 0.3, 0});
  session_.deform_loop().finish();
  EXPECT_GT(greatest_distance(document.deformed_beside()->positions, shown_model()), 1e-4);
}

TEST_F(SessionTest, MeasuresWhatBecameOfTheModelOnceItRests) {
  open_and_bind();
  const Document& document = session_.document();
  ASSERT_TRUE(document.state().binding->unseen());
  EXPECT_GT(document.state().binding->unseen()->mean, 0) << "across the hole of the torus";
  ASSERT_TRUE(wait_until([&] { return document.following() && !session_.checker().busy(); }));
  EXPECT_NEAR(document.following()->mean_stretch, 1, 1e-4);
  drag(3, {0.5, 0, 0});
  ASSERT_TRUE(wait_until([&] { return document.following()->mean_stretch > 1.001; }));
  EXPECT_GT(document.following()->high_stretch, document.following()->mean_stretch);
  session_.refine();
  EXPECT_FALSE(document.following());
}

/// The torus, and another one beside it, as two groups of one file.
PolygonMesh two_groups() {
  PolygonMesh both(make_torus(0.25, 40, 20));
  both.group_names = {"left", "right"};
  both.face_groups.assign(both.face_count(), 0);
  const auto first = static_cast<Index>(both.positions.size());
  const TriangleMesh other = make_torus(0.25, 24, 12);
  for (const Vec3& p : other.positions) {
    both.positions.emplace_back(p + 5 * Vec3::UnitX());
  }
  for (const Triangle& t : other.triangles) {
    both.add_face({t[0] + first, t[1] + first, t[2] + first});
    both.face_groups.push_back(1);
  }
  return both;
}

TEST_F(SessionTest, MakesTheCageForAGroupAndLeavesTheRestWhereItIs) {
  ASSERT_TRUE(write_mesh(two_groups(), path("two.obj")));
  session_.open(path("two.obj"));
  wait();
  const Document& document = session_.document();
  const std::vector<NamedPart> parts = named_parts(*document.model());
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[1].name.toStdString(), "right");
  session_.choose_region(parts[1].name, parts[1].faces);
  wait();
  ASSERT_TRUE(document.state().region);
  GenerateSettings settings;
  settings.options.vertices = 40;
  settings.options.rounds = 0; // quick
  session_.set_settings(settings);
  session_.generate();
  wait();
  ASSERT_TRUE(document.has_cage()) << failures_.front();
  for (const Vec3& p : document.cage_positions()) {
    EXPECT_GT(p.x(), 2) << "round the right one alone";
  }
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_TRUE(document.check().report->valid()) << "for the right one";

  session_.bind();
  wait();
  ASSERT_EQ(document.mode(), Mode::deform);
  const std::vector<Vec3>& rest = document.model()->mesh.positions;
  std::vector<Index> all;
  std::vector<Vec3> to;
  for (Index v = 0; v < cage().size(); ++v) {
    all.push_back(v);
    to.emplace_back(cage()[v] + Vec3::UnitY());
  }
  session_.editor().move(all, to, "Move");
  const std::vector<Vec3> shown = shown_model();
  ASSERT_EQ(shown.size(), rest.size());
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const bool bound = rest[v].x() > 2;
    ASSERT_LT((shown[v] - rest[v] - (bound ? Vec3(Vec3::UnitY()) : Vec3(Vec3::Zero()))).norm(),
              1e-5);
  }
  Layers layers = document.layers();
  layers.weights = true;
  session_.document().set_layers(layers);
  session_.editor().select(
      {.mode = SelectionMode::vertex, .vertices = {0}, .edges = {}, .faces = {}});
  session_.deform_loop().finish();
  ASSERT_EQ(document.model_weights().size(), rest.size());
  EXPECT_EQ(document.model_weights()[0], 0);

  session_.export_model(path("out.ply"));
  wait();
  ASSERT_TRUE(failures_.empty()) << failures_.front();
  const auto written = read_mesh(path("out.ply"));
  ASSERT_TRUE(written);
  EXPECT_LT(greatest_distance(written->positions, shown), 1e-5) << "all of it, in its order";

  // And so it comes back.
  ASSERT_TRUE(session_.save_project(path("part.cagewright")));
  session_.open(path("model.obj"));
  wait();
  EXPECT_FALSE(document.state().region);
  session_.open(path("part.cagewright"));
  wait();
  ASSERT_TRUE(document.state().region);
  EXPECT_EQ(document.state().region->faces, parts[1].faces);
  EXPECT_EQ(document.state().region->name, parts[1].name);
  EXPECT_LT(greatest_distance(shown_model(), shown), 1e-5);
}

/// The torus in a scan: dust far away, and a vertex that no face uses.
PolygonMesh dusty() {
  PolygonMesh mesh(make_torus(0.25, 40, 20));
  const auto first = static_cast<Index>(mesh.positions.size());
  for (const Vec3& p : {Vec3(40, 0, 0), Vec3(40.01, 0, 0), Vec3(40, 0.01, 0), Vec3(0, 0, -60)}) {
    mesh.positions.push_back(p);
  }
  mesh.add_face({first, first + 1, first + 2});
  return mesh;
}

TEST_F(SessionTest, KnowsThatACageIsForAllButSpecks) {
  const PolygonMesh scan = dusty();
  ASSERT_TRUE(write_mesh(scan, path("scan.obj")));
  session_.open(path("scan.obj"));
  wait();
  const Document& document = session_.document();
  GenerateSettings settings;
  settings.options.vertices = 40;
  settings.options.rounds = 0; // quick
  settings.options.ignore_specks = true;
  session_.set_settings(settings);
  for (int times = 0; times < 2; ++times) { // the second time there is no speck any more
    session_.generate();
    wait();
    ASSERT_TRUE(document.has_cage()) << failures_.front();
    ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
    EXPECT_TRUE(document.check().report->valid()) << "it is judged by what it is for";
    ASSERT_TRUE(document.state().region);
    EXPECT_EQ(document.state().region->faces.size(), scan.face_count() - 1);
  }
  session_.bind(Session::Doubts::tell);
  wait();
  EXPECT_EQ(document.mode(), Mode::deform) << "no doubts";
  session_.refine();
  QUndoStack& stack = session_.editor().undo_stack();
  while (stack.canUndo()) {
    stack.undo();
  }
  EXPECT_FALSE(document.state().region);
  // The same for a cage from elsewhere.
  session_.load_cage(path("cage.obj"));
  wait();
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_FALSE(document.check().report->valid());
  session_.choose_all_but_specks();
  wait();
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_TRUE(document.check().report->valid());
  ASSERT_TRUE(session_.save_project(path("scan.cagewright")));
  session_.open(path("model.obj"));
  wait();
  session_.choose_all_but_specks();
  wait();
  EXPECT_FALSE(document.state().region) << "it has none";
  session_.open(path("scan.cagewright"));
  wait();
  ASSERT_TRUE(document.state().region);
  EXPECT_EQ(document.state().region->faces.size(), scan.face_count() - 1);
}

TEST_F(SessionTest, LeavesOutVerticesThatNoFaceUses) {
  PolygonMesh mesh(make_torus(0.25, 40, 20));
  mesh.positions.emplace_back(0, 0, -60);
  ASSERT_TRUE(write_mesh(mesh, path("loose.obj")));
  session_.open(path("loose.obj"), path("cage.obj"));
  wait();
  session_.choose_all_but_specks();
  wait();
  const Document& document = session_.document();
  ASSERT_TRUE(document.state().region);
  EXPECT_EQ(document.state().region->vertices.size(), mesh.positions.size() - 1);
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_TRUE(document.check().report->valid());
}

TEST_F(SessionTest, TakesBackWhatTheCageIsFor) {
  ASSERT_TRUE(write_mesh(two_groups(), path("two.obj")));
  session_.open(path("two.obj"), path("cage.obj"));
  wait();
  const Document& document = session_.document();
  const std::vector<NamedPart> parts = named_parts(*document.model());
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_FALSE(document.check().report->valid()) << "the right one is outside";
  session_.choose_region(parts[0].name, parts[0].faces);
  wait();
  EXPECT_TRUE(document.has_cage()) << "the cage that is there stays";
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_TRUE(document.check().report->valid());
  session_.editor().undo_stack().undo();
  EXPECT_FALSE(document.state().region);
  session_.editor().undo_stack().redo();
  EXPECT_TRUE(document.state().region);
  session_.choose_region("none", {});
  wait();
  EXPECT_EQ(failures_.size(), 1U) << "nothing is chosen";
  session_.bind();
  wait();
  ASSERT_EQ(document.mode(), Mode::deform);
  session_.choose_region(parts[1].name, parts[1].faces);
  wait();
  EXPECT_EQ(document.state().region->faces, parts[0].faces) << "it is bound";
}

TEST_F(SessionTest, MakesQuadsWhereTheyAreAskedFor) {
  session_.open(path("model.obj"));
  wait();
  GenerateSettings settings;
  settings.options.vertices = 24;
  settings.options.rounds = 0; // quick
  settings.options.quads = true;
  session_.set_settings(settings);
  session_.generate();
  wait();
  ASSERT_TRUE(session_.document().has_cage()) << failures_.front();
  const PolygonMesh& cage = session_.document().cage_rest();
  std::size_t quads = 0;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    quads += cage.face(f).size() == 4 ? 1 : 0;
  }
  EXPECT_GT(quads, 0U);
  EXPECT_NE(message_.find("quads"), std::string::npos) << message_;
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_TRUE(session_.document().check().report->valid());
}

TEST_F(SessionTest, MakesTheCageFinerWhereAFileSaysSo) {
  session_.open(path("model.obj"));
  wait();
  GenerateSettings settings;
  settings.options.vertices = 60;
  settings.density = DensitySource::file;
  settings.density_file = QString::fromStdString(path("density.txt").string());
  {
    std::ofstream file(path("density.txt"));
    for (const Vec3& p : session_.document().model()->mesh.positions) {
      file << (p.x() > 0 ? 50 : 1) << '\n';
    }
  }
  session_.set_settings(settings);
  session_.generate();
  wait();
  ASSERT_TRUE(session_.document().has_cage()) << failures_.front();
  const std::vector<Vec3> made = cage();
  const auto on_the_right =
      std::count_if(made.begin(), made.end(), [](const Vec3& p) { return p.x() > 0; });
  EXPECT_GT(3 * on_the_right, 2 * static_cast<std::ptrdiff_t>(made.size()));
}

TEST_F(SessionTest, SaysWhatADensityLacks) {
  session_.open(path("model.obj"));
  wait();
  std::ofstream(path("short.txt")) << "1\n2\n";
  GenerateSettings settings;
  const auto failure = [&] {
    failures_.clear();
    session_.set_settings(settings);
    session_.generate();
    wait();
    return failures_.empty() ? std::string() : failures_.front();
  };
  settings.density = DensitySource::colors;
  EXPECT_NE(failure().find("no vertex colors"), std::string::npos);
  settings.density = DensitySource::file;
  EXPECT_NE(failure().find("choose the file"), std::string::npos);
  settings.density_file = QString::fromStdString(path("short.txt").string());
  EXPECT_NE(failure().find("short.txt"), std::string::npos);
  settings.density = DensitySource::even;
  settings.options.vertices = 0;
  EXPECT_NE(failure().find("needs a limit"), std::string::npos);
  EXPECT_FALSE(session_.document().has_cage());
}

TEST(GenerateSettings, ComeBackFromAFile) {
  GenerateSettings settings;
  for (const GenerateOption& option : generate_options()) { // each another than its default
    if (const auto* integer = std::get_if<GenerateOption::Integer>(&option.kind)) {
      const int value = integer->get(settings);
      integer->set(settings, value == integer->most ? value - 1 : value + 1);
    } else if (const auto* number = std::get_if<GenerateOption::Number>(&option.kind)) {
      number->value(settings) = (number->value(settings) + number->most) / 2;
    } else if (const auto* file = std::get_if<GenerateOption::File>(&option.kind)) {
      file->value(settings) = "numbers.txt";
    } else {
      const auto& choice = std::get<GenerateOption::Choice>(option.kind);
      choice.set(settings, choice.get(settings) == 0 ? 1 : 0);
    }
  }
  const QJsonObject json = to_json(settings);
  EXPECT_EQ(to_json(generate_settings_from_json(json)), json);
  const QJsonObject defaults = to_json(GenerateSettings());
  for (const GenerateOption& option : generate_options()) {
    EXPECT_NE(json[option.key], defaults[option.key]) << option.key.toStdString();
    EXPECT_FALSE(option.help.isEmpty());
  }
}

TEST(GenerateSettings, OfAnEarlierVersionAreUnderstood) {
  EXPECT_EQ(generate_settings_from_json({{"method", "obb"}}).options.method,
            Method::boxes_improved);
  const GenerateSettings unknown = generate_settings_from_json({{"method", "wrap"}});
  EXPECT_EQ(unknown.options.method, Method::envelope);
  EXPECT_EQ(vertex_limit(unknown.options), 100);
}

TEST_F(SessionTest, KeepsTheOldCageWhenGeneratingIsCancelled) {
  session_.open(path("model.obj"), path("cage.obj"));
  wait();
  const auto before = session_.document().state().rest;
  session_.generate();
  session_.cancel();
  wait();
  EXPECT_EQ(session_.document().state().rest, before);
  EXPECT_TRUE(failures_.empty());
  EXPECT_NE(message_.find("cancelled"), std::string::npos) << message_;
}

TEST_F(SessionTest, FindsFacesThatNoLongerFit) {
  session_.open(path("model.obj"), path("cage.obj"));
  wait();
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  ASSERT_TRUE(session_.document().check().report->valid());
  session_.editor().move({0}, std::vector<Vec3>{Vec3(0, 0, 0)}, "Move");
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_FALSE(session_.document().check().report->valid());
  EXPECT_FALSE(session_.document().offending_faces().empty());
  session_.editor().undo_stack().undo();
  ASSERT_TRUE(wait_until([this] { return !session_.checker().busy(); }));
  EXPECT_TRUE(session_.document().check().report->valid());
  EXPECT_TRUE(session_.document().offending_faces().empty());
}

TEST_F(SessionTest, MovesTheModelWithItsCage) {
  open_and_bind();
  const std::vector<Vec3> rest = shown_model();
  std::vector<Index> all;
  std::vector<Vec3> to;
  for (Index v = 0; v < cage().size(); ++v) {
    all.push_back(v);
    to.push_back(2 * cage()[v] + Vec3(1, 2, 3));
  }
  session_.editor().move(all, to, "Move");
  std::vector<Vec3> expected = rest;
  for (Vec3& p : expected) {
    p = 2 * p + Vec3(1, 2, 3);
  }
  EXPECT_LT(greatest_distance(shown_model(), expected), 1e-5);
  session_.editor().undo_stack().undo();
  EXPECT_LT(greatest_distance(shown_model(), rest), 1e-9);
}

TEST_F(SessionTest, ShowsWhatTheUserComparesAndBlends) {
  open_and_bind();
  const std::vector<Vec3> rest = shown_model();
  drag(3, {0.3, 0, 0});
  const std::vector<Vec3> posed = shown_model();
  EXPECT_GT(greatest_distance(rest, posed), 0.01);
  session_.document().set_comparing(true);
  EXPECT_LT(greatest_distance(shown_model(), rest), 1e-9);
  session_.document().set_comparing(false);
  EXPECT_LT(greatest_distance(shown_model(), posed), 1e-9);
  session_.document().set_blend(0.5);
  std::vector<Vec3> half = rest;
  for (std::size_t i = 0; i < half.size(); ++i) {
    half[i] = (rest[i] + posed[i]) / 2;
  }
  EXPECT_LT(greatest_distance(shown_model(), half), 1e-6);
  drag(5, {0, 0.1, 0}); // goes on from what is shown
  EXPECT_EQ(session_.document().blend(), 1);
  EXPECT_NEAR((cage()[3] - session_.document().cage_rest().positions[3]).x(), 0.15, 1e-12);
}

TEST_F(SessionTest, TellsWhichVerticesFollowTheSelection) {
  open_and_bind();
  Layers layers = session_.document().layers();
  layers.weights = true;
  session_.document().set_layers(layers);
  session_.editor().select(
      {.mode = SelectionMode::vertex, .vertices = {4}, .edges = {}, .faces = {}});
  session_.deform_loop().finish();
  const std::vector<float> weights(session_.document().model_weights().begin(),
                                   session_.document().model_weights().end());
  const std::vector<Vec3> rest = shown_model();
  ASSERT_EQ(weights.size(), rest.size());
  drag(4, {0, 0, 1});
  const std::vector<Vec3> moved = shown_model();
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_NEAR(moved[i].z() - rest[i].z(), weights[i], 1e-5);
  }
}

TEST_F(SessionTest, ExportsWhatIsShownAndEveryPose) {
  open_and_bind();
  drag(2, {0.2, 0.1, 0});
  session_.editor().add_pose("bent / sideways");
  const std::vector<Vec3> posed = shown_model();
  session_.editor().reset_pose();
  session_.editor().add_pose("rest");
  session_.export_poses(path("out.obj"));
  wait();
  const auto bent = read_mesh(path("out-bent___sideways.obj"));
  const auto rest = read_mesh(path("out-rest.obj"));
  ASSERT_TRUE(bent) << bent.error().message;
  ASSERT_TRUE(rest) << rest.error().message;
  EXPECT_LT(greatest_distance(bent->positions, posed), 1e-6);
  EXPECT_LT(greatest_distance(rest->positions, session_.document().model()->mesh.positions), 1e-12);
  EXPECT_TRUE(failures_.empty());
}

TEST_F(SessionTest, KeepsWhatPosesMoveWhenTheCageIsRefined) {
  open_and_bind();
  const std::vector<Vec3> rest = cage();
  drag(2, {0.2, 0.1, 0});
  session_.editor().add_pose("bent");
  session_.editor().set_keyframe(5);
  session_.editor().refine();
  drag(2, {0, 0, 0.03});
  drag(7, {0.02, 0, 0});
  session_.bind();
  wait();
  ASSERT_EQ(session_.document().mode(), Mode::deform);
  session_.editor().apply_pose(0);
  std::vector<Vec3> expected = rest;
  expected[2] += Vec3(0.2, 0.1, 0.03);
  expected[7] += Vec3(0.02, 0, 0);
  EXPECT_LT(greatest_distance(cage(), expected), 1e-15);
  const State& state = session_.document().state();
  EXPECT_EQ(*state.time_line.keys[0].positions, *state.poses[0].positions);
  while (session_.editor().undo_stack().canUndo()) {
    session_.editor().undo_stack().undo();
  }
  EXPECT_EQ(cage(), rest);
}

TEST_F(SessionTest, SaysThatPosesGoWithTheCageTheyFit) {
  open_and_bind();
  session_.editor().add_pose("one");
  session_.load_cage(path("cage.obj"));
  std::string said;
  QObject::connect(&session_, &Session::message,
                   [&](const QString& text) { said += text.toStdString(); });
  wait();
  EXPECT_TRUE(session_.document().state().poses.empty());
  EXPECT_NE(said.find("undo brings it back"), std::string::npos) << said;
  session_.editor().undo_stack().undo();
  EXPECT_EQ(session_.document().state().poses.size(), 1U);
}

TEST_F(SessionTest, MovesSeveralModelsUnderOneCage) {
  PolygonMesh eye(make_icosphere(1));
  for (Vec3& p : eye.positions) {
    p = 0.1 * p + Vec3(1, 0, 0);
  }
  ASSERT_TRUE(write_mesh(eye, path("eye.ply")));
  open_and_bind();
  drag(0, Vec3(0.3, 0, 0));
  session_.editor().add_pose("Bent");
  session_.add_model(path("eye.ply"));
  wait();
  EXPECT_EQ(session_.document().mode(), Mode::refine) << "to be bound with the other one";
  EXPECT_EQ(session_.document().state().poses.size(), 1U);
  EXPECT_EQ(session_.title().toStdString(), "model.obj and 1 more");
  const std::size_t together = session_.document().model()->mesh.positions.size();
  EXPECT_EQ(together, session_.document().model()->parts[1].first + eye.positions.size());
  session_.bind();
  wait();
  ASSERT_EQ(session_.document().mode(), Mode::deform);
  session_.editor().apply_pose(0);
  const std::vector<Vec3> shown = shown_model();
  session_.export_model(path("out.obj"));
  wait();
  ASSERT_TRUE(failures_.empty()) << failures_.front();
  std::size_t at = 0;
  for (const char* name : {"out-model.obj", "out-eye.obj"}) {
    const auto written = read_mesh(path(name));
    ASSERT_TRUE(written) << written.error().message;
    for (const Vec3& p : written->positions) {
      ASSERT_LT((p - shown[at++]).norm(), 1e-5) << name;
    }
  }
  EXPECT_EQ(at, together);
  EXPECT_EQ(message_, "Wrote out-model.obj and out-eye.obj");
  // The file that is chosen is none of those that are written: nobody else has asked about them.
  std::vector<std::string> asked;
  bool goes_on = false;
  session_.set_asker([&](const Question& question) {
    asked.push_back(question.text.toStdString());
    return goes_on;
  });
  fs::remove(path("out-eye.obj"));
  message_.clear();
  session_.export_model(path("out.obj"));
  wait();
  ASSERT_EQ(asked, std::vector<std::string>{"out-model.obj is there already."});
  EXPECT_FALSE(fs::exists(path("out-eye.obj"))) << "nothing is written";
  EXPECT_EQ(message_, "");
  goes_on = true;
  session_.export_model(path("out.obj"));
  wait();
  EXPECT_TRUE(fs::exists(path("out-eye.obj")));
  session_.export_model(path("out.obj"));
  wait();
  EXPECT_EQ(asked.back(), "2 of the files are there already, out-model.obj to out-eye.obj.");
  session_.export_model(path("other.obj"));
  wait();
  EXPECT_EQ(asked.size(), 3U);
  session_.set_asker({});
  // And they come back together.
  ASSERT_TRUE(session_.save_project(path("both.cagewright")));
  session_.open(path("model.obj"));
  wait();
  EXPECT_EQ(session_.document().model()->parts.size(), 1U);
  session_.open(path("both.cagewright"));
  wait();
  ASSERT_TRUE(failures_.empty()) << failures_.front();
  EXPECT_EQ(session_.document().model()->mesh.positions.size(), together);
  EXPECT_EQ(session_.document().mode(), Mode::deform);
}

TEST_F(SessionTest, ComesBackToTheFrameItStoodAt) {
  open_and_bind();
  Document& document = session_.document();
  session_.editor().set_keyframe(1);
  document.set_time(29);
  drag(0, Vec3(0.3, 0, 0));
  session_.editor().set_keyframe(29);
  document.set_time(40);
  drag(0, Vec3(0, 0.3, 0)); // and no keyframe yet
  const std::vector<Vec3> edited = cage();
  for (const bool shows_frame : {false, true}) {
    if (shows_frame) {
      document.set_time(20.5);
    }
    const std::vector<Vec3> shown(document.shown_cage_positions().begin(),
                                  document.shown_cage_positions().end());
    const double frame = document.frame();
    ASSERT_TRUE(session_.save_project(path("walk.cagewright")));
    session_.open(path("model.obj"));
    wait();
    session_.open(path("walk.cagewright"));
    wait();
    EXPECT_EQ(document.frame(), frame) << "a keyframe would go there";
    EXPECT_EQ(document.time().has_value(), shows_frame);
    EXPECT_EQ(greatest_distance(document.shown_cage_positions(), shown), 0);
    EXPECT_EQ(greatest_distance(cage(), edited), 0) << "the edited pose is what it was";
  }
}

TEST_F(SessionTest, ExportsTheTimeLineAsOneFileThatMoves) {
  open_and_bind();
  session_.export_animation(path("no.glb"));
  ASSERT_EQ(failures_.size(), 1U);
  failures_.clear();
  session_.editor().set_keyframe(1);
  drag(0, Vec3(0.3, 0, 0));
  session_.editor().set_keyframe(5);
  TimeLine line = session_.document().state().time_line;
  line.last = 7;
  session_.editor().set_time_line(line, "Shorter");
  for (const char* name : {"moves.glb", "moves.pc2", "moves.mdd"}) {
    session_.export_animation(path(name));
    wait();
    ASSERT_TRUE(failures_.empty()) << failures_.front();
  }
  // Of the point cache frame 3 is what the window shows there.
  session_.document().set_time(3);
  const std::vector<Vec3> shown = shown_model();
  QFile file(QString::fromStdString(path("moves.pc2").string()));
  ASSERT_TRUE(file.open(QIODevice::ReadOnly));
  const QByteArray bytes = file.readAll();
  ASSERT_EQ(static_cast<std::size_t>(bytes.size()), 32 + 7 * shown.size() * 12);
  for (std::size_t v = 0; v < shown.size(); ++v) {
    float xyz[3];
    std::memcpy(xyz, bytes.constData() + 32 + (2 * shown.size() + v) * 12, sizeof(xyz));
    ASSERT_LT((Vec3(xyz[0], xyz[1], xyz[2]) - shown[v]).norm(), 1e-5);
  }
  const auto glb = read_mesh(path("moves.glb"));
  ASSERT_TRUE(glb) << glb.error().message;
}

TEST_F(SessionTest, KeepsTheMixOfPosesAndWhatWasPainted) {
  open_and_bind();
  drag(0, Vec3(0.3, 0, 0));
  session_.editor().add_pose("A");
  session_.editor().reset_pose();
  session_.editor().mix_pose(0, 0.25);
  session_.editor().set_keyframe(3);
  const std::vector<Vec3> mixed = cage();
  std::vector<float> density(session_.document().model()->mesh.positions.size(), 0.0F);
  density[5] = 0.5F;
  density[7] = -1;
  session_.editor().set_density(std::make_shared<const std::vector<float>>(density), "Paint");
  ASSERT_TRUE(session_.save_project(path("mix.cagewright")));
  session_.open(path("model.obj"));
  wait();
  EXPECT_FALSE(session_.document().state().density);
  session_.open(path("mix.cagewright"));
  wait();
  ASSERT_TRUE(failures_.empty()) << failures_.front();
  EXPECT_EQ(cage(), mixed);
  EXPECT_EQ(session_.document().state().poses[0].share, 0.25);
  EXPECT_EQ(session_.document().state().time_line.keys[0].shares, std::vector<double>{0.25});
  ASSERT_TRUE(session_.document().state().density);
  EXPECT_EQ(*session_.document().state().density, density);
  EXPECT_EQ(session_.settings().density, DensitySource::painted);
  session_.editor().mix_pose(0, 1);
  EXPECT_EQ(cage(), *session_.document().state().poses[0].positions);
}

TEST_F(SessionTest, BindsTheRegionByTwoKindsAndKeepsWhatIsPaintedInRange) {
  session_.open(path("model.obj"), path("cage.obj"));
  wait();
  const std::size_t count = session_.document().model()->mesh.positions.size();
  std::vector<Index> half(session_.document().model()->mesh.face_count() / 2);
  std::iota(half.begin(), half.end(), Index{0});
  session_.choose_region("half", half);
  wait();
  std::vector<float> painted(count, 0.0F);
  for (std::size_t v = 0; v < count / 3; ++v) {
    painted[v] = 0.5F;
  }
  session_.editor().set_mix(std::make_shared<const std::vector<float>>(painted), "Paint");
  GenerateSettings settings = session_.settings();
  settings.mixed = "harmonic";
  session_.set_settings(settings);
  session_.bind(Session::Doubts::ignore);
  wait();
  ASSERT_TRUE(failures_.empty()) << failures_.front();
  ASSERT_EQ(session_.document().mode(), Mode::deform);
  EXPECT_EQ(session_.document().state().binding->settings().name(), "mean_value+harmonic");
  drag(0, Vec3(0.3, 0, 0));
  const std::vector<Vec3> moved = shown_model();
  session_.export_model(path("out.obj"));
  wait();
  const auto out = read_mesh(path("out.obj"));
  ASSERT_TRUE(out);
  EXPECT_LT(greatest_distance(out->positions, moved), 1e-5);
  ASSERT_TRUE(session_.save_project(path("half.cagewright")));

  // A share of -0.5 is none.
  Project project = *read_project(path("half.cagewright"));
  ASSERT_TRUE(project.state.mix);
  EXPECT_EQ(*project.state.mix, painted);
  std::vector<float> wrong = painted;
  wrong[0] = -0.5F;
  project.state.mix = std::make_shared<const std::vector<float>>(wrong);
  ASSERT_TRUE(write_project(project, path("wrong.cagewright")));
  const Result<Project> read = read_project(path("wrong.cagewright"));
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->state.mix);
  ASSERT_EQ(read->notes.size(), 1U);
  EXPECT_NE(read->notes[0].find("painted"), std::string::npos) << read->notes[0];
}

TEST_F(SessionTest, SaysWhichKindsCannotBeMixed) {
  GenerateSettings settings = session_.settings();
  settings.coordinates = "somigliana";
  session_.set_settings(settings);
  open_and_bind();
  settings.coordinate_numbers["local"] = 0.5;
  settings.mixed = "green";
  session_.set_settings(settings);
  wait();
  ASSERT_EQ(failures_.size(), 1U);
  EXPECT_NE(failures_[0].find("local"), std::string::npos) << failures_[0];
  EXPECT_EQ(session_.settings().mixed, "") << "what is bound is shown";
  EXPECT_EQ(session_.document().mode(), Mode::deform);
}

TEST_F(SessionTest, ExportsASequenceAlongTheKeyframes) {
  open_and_bind();
  session_.document().set_time(1);
  session_.editor().set_keyframe(1);
  drag(2, {0.4, 0, 0});
  const std::vector<Vec3> end = shown_model();
  session_.editor().set_keyframe(11);
  TimeLine line = session_.document().state().time_line;
  line.last = 11;
  session_.editor().set_time_line(line, "Shorter");
  session_.export_sequence(path("walk.ply"), 5);
  wait();
  EXPECT_TRUE(failures_.empty()) << failures_.front();
  const auto first = read_mesh(path("walk-0001.ply"));
  const auto middle = read_mesh(path("walk-0006.ply"));
  const auto last = read_mesh(path("walk-0011.ply"));
  ASSERT_TRUE(first && middle && last);
  const auto& rest = session_.document().model()->mesh.positions;
  EXPECT_LT(greatest_distance(first->positions, rest), 1e-9);
  EXPECT_LT(greatest_distance(last->positions, end), 1e-6);
  EXPECT_GT(greatest_distance(middle->positions, rest), 1e-3);
}

TEST_F(SessionTest, ExportsWeightsThatBelongToModelAndCage) {
  open_and_bind();
  session_.export_weights(path("weights.npz"));
  wait();
  const auto stored = read_weights(path("weights.npz"));
  ASSERT_TRUE(stored) << stored.error().message;
  EXPECT_TRUE(belongs_to(*stored, session_.document().model()->mesh.positions,
                         session_.document().cage_rest()));
}

TEST_F(SessionTest, ComesBackFromAProjectAsItWas) {
  open_and_bind();
  drag(1, {0.1, 1.0 / 3, 0});
  session_.editor().add_pose("one");
  session_.editor().set_keyframe(7);
  GenerateSettings settings;
  settings.options.method = Method::boxes_improved;
  settings.options.clearance = 0.0123;
  session_.set_settings(settings);
  Layers layers = session_.document().layers();
  layers.wireframe = true;
  session_.document().set_layers(layers);
  const std::vector<Vec3> posed = shown_model();
  const std::vector<Vec3> pose = cage();
  EXPECT_TRUE(session_.modified());
  ASSERT_TRUE(session_.save_project(path("work.cagewright")));
  EXPECT_FALSE(session_.modified());
  session_.editor().reset_pose();
  session_.set_settings({});

  session_.open(path("work.cagewright"));
  wait();
  EXPECT_TRUE(failures_.empty()) << failures_.front();
  EXPECT_EQ(session_.document().mode(), Mode::deform);
  EXPECT_EQ(cage(), pose);
  EXPECT_LT(greatest_distance(shown_model(), posed), 1e-9);
  ASSERT_EQ(session_.document().state().poses.size(), 1U);
  EXPECT_EQ(session_.document().state().poses[0].name, "one");
  ASSERT_EQ(session_.document().state().time_line.keys.size(), 1U);
  EXPECT_EQ(session_.document().state().time_line.keys[0].frame, 7);
  EXPECT_TRUE(session_.document().layers().wireframe);
  EXPECT_EQ(session_.settings().options.method, Method::boxes_improved);
  EXPECT_EQ(session_.settings().options.clearance, 0.0123);
  EXPECT_FALSE(session_.modified());
}

TEST_F(SessionTest, FindsTheModelOfAProjectThatWasMoved) {
  open_and_bind();
  ASSERT_TRUE(session_.save_project(path("work.cagewright")));
  fs::create_directory(path("elsewhere"));
  fs::rename(path("work.cagewright"), path("elsewhere/work.cagewright"));
  fs::rename(path("model.obj"), path("elsewhere/model.obj"));
  QString missing;
  QObject::connect(&session_, &Session::modelMissing,
                   [&](const QString&, const QString& model) { missing = model; });
  session_.open(path("elsewhere/work.cagewright"));
  wait();
  EXPECT_TRUE(missing.isEmpty()) << missing.toStdString();
  EXPECT_EQ(session_.document().model()->path, path("elsewhere/model.obj"));
  fs::remove(path("elsewhere/model.obj"));
  session_.open(path("elsewhere/work.cagewright"));
  wait();
  EXPECT_FALSE(missing.isEmpty());
}

TEST_F(SessionTest, SaysWhatIsWrongWithFiles) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"no.obj", ""},
      {"text.obj", "hello\n"},
      {"empty.cagewright", ""},
      {"other.cagewright", "{\"format\": \"something\"}"},
      {"broken.cagewright", "{\"format\": \"cagewright-project\", \"version\": 1, \"cage\": "
                            "{\"vertices\": [[0,0,0]], \"faces\": [[0,1,2]]}}"},
      {"poses.cagewright", "{\"format\": \"cagewright-project\", \"version\": 1, \"cage\": "
                           "{\"vertices\": [[0,0,0],[1,0,0],[0,1,0]], \"faces\": [[0,1,2]]}, "
                           "\"pose\": [[0,0,0]]}"},
      {"later.cagewright", "{\"format\": \"cagewright-project\", \"version\": 99}"}};
  for (const auto& [name, content] : files) {
    if (name != "no.obj") {
      std::ofstream(path(name)) << content;
    }
    failures_.clear();
    session_.open(path(name));
    wait();
    ASSERT_EQ(failures_.size(), 1U) << name;
    EXPECT_NE(failures_[0].find(name), std::string::npos) << failures_[0];
    EXPECT_FALSE(session_.document().has_model());
  }
}

TEST_F(SessionTest, RefusesToBindAnOpenCage) {
  PolygonMesh open_cage;
  open_cage.positions = {{-9, -9, -9}, {9, -9, -9}, {0, 9, -9}};
  open_cage.add_face({0, 1, 2});
  ASSERT_TRUE(write_mesh(open_cage, path("open.obj")));
  session_.open(path("model.obj"), path("open.obj"));
  wait();
  int doubts = 0;
  QObject::connect(&session_, &Session::bindingDoubtful, [&] { ++doubts; });
  session_.bind();
  ASSERT_TRUE(wait_until([&] { return doubts == 1; }));
  EXPECT_EQ(session_.document().mode(), Mode::refine);
  EXPECT_TRUE(failures_.empty());
  session_.bind(Session::Doubts::ignore);
  wait();
  EXPECT_EQ(session_.document().mode(), Mode::refine);
  EXPECT_EQ(failures_.size(), 1U);
}

/// A project with one thing of it replaced.
TEST_F(SessionTest, FitsACageOfAnotherUnitUpAxisAndPlace) {
  open_and_bind();
  drag(0, Vec3(0.05, 0, 0));
  session_.editor().add_pose("Bent");
  session_.refine();
  const std::vector<Vec3> good = cage();
  const auto twisted = [](const Vec3& p) { return Vec3(100 * Vec3(p.x(), -p.z(), p.y() + 4)); };
  PolygonMesh wrong = session_.document().cage();
  std::ranges::transform(wrong.positions, wrong.positions.begin(), twisted);
  session_.editor().adjust_cage(std::make_shared<const PolygonMesh>(wrong), twisted, "Twist");

  session_.fit_cage_to_model();
  wait();
  EXPECT_NE(message_.find("turned by"), std::string::npos) << message_;
  const std::vector<Vec3> fitted = cage();
  const auto off_the_ring = [](const Vec3& p) {
    return std::hypot(std::hypot(p.x(), p.y()) - 1, p.z());
  };
  for (std::size_t v = 0; v < good.size(); ++v) { // which way up a ring lies there is no telling
    EXPECT_NEAR(off_the_ring(fitted[v]), off_the_ring(good[v]), 0.2) << v;
  }
  // What a pose moves it moves there, too.
  ASSERT_EQ(session_.document().state().poses.size(), 1U);
  const std::vector<Vec3>& pose = *session_.document().state().poses[0].positions;
  EXPECT_NEAR((pose[0] - fitted[0]).norm(), 0.05, 1e-9);
  EXPECT_LT((pose[1] - fitted[1]).norm(), 1e-9);
  session_.fit_cage_to_model(Session::Then::bind);
  wait();
  EXPECT_NE(message_.find("no scale"), std::string::npos) << message_;
  session_.editor().undo_stack().undo();
  EXPECT_EQ(cage(), wrong.positions) << "a step of undo";
}

TEST_F(SessionTest, MendsCagesAndSaysWhereThereIsNothingToMend) {
  session_.weld_cage();
  EXPECT_NE(message_.find("no cage"), std::string::npos) << message_;
  open_and_bind();
  session_.weld_cage();
  EXPECT_NE(message_.find("go back to refining"), std::string::npos) << message_;
  session_.refine();
  session_.weld_cage();
  EXPECT_NE(message_.find("no vertices"), std::string::npos) << message_;
  session_.turn_cage_outward();
  EXPECT_NE(message_.find("all faces look outward"), std::string::npos) << message_;
  PolygonMesh turned;
  const PolygonMesh good = session_.document().cage();
  turned.positions = good.positions;
  for (std::size_t f = 0; f < good.face_count(); ++f) {
    turned.add_face(std::vector<Index>(good.face(f).rbegin(), good.face(f).rend()));
  }
  session_.editor().replace_cage(std::make_shared<const PolygonMesh>(turned), nullptr, "Turned");
  session_.turn_cage_outward(Session::Then::bind);
  ASSERT_TRUE(wait_until([this] { return session_.document().mode() == Mode::deform; }));
}

TEST_F(SessionTest, RefusesNumbersOutOfRangeAndNamesThem) {
  open_and_bind();
  session_.editor().set_keyframe(4);
  ASSERT_TRUE(session_.save_project(path("good.cagewright")));
  std::ifstream file(path("good.cagewright"));
  const std::string good((std::istreambuf_iterator<char>(file)), {});
  const auto opened_with = [&](const std::string& name, const std::string& value) {
    const std::size_t at = good.find("\"" + name + "\": ");
    EXPECT_NE(at, std::string::npos) << name;
    const std::size_t begin = at + name.size() + 4;
    std::string text = good;
    text.replace(begin, good.find_first_of(",\n", begin) - begin, value);
    std::ofstream(path("wrong.cagewright")) << text;
    failures_.clear();
    session_.open(path("wrong.cagewright"));
    wait();
    return failures_.empty() ? std::string() : failures_.front();
  };
  const std::pair<const char*, const char*> errors[] = {{"first", "-2147483648"},
                                                        {"last", "2147483647"},
                                                        {"last", "-50"},
                                                        {"last", "1e300"},
                                                        {"frames_per_second", "0"},
                                                        {"frames_per_second", "1e9"},
                                                        {"frame", "100000000"},
                                                        {"frame", "1.5"},
                                                        {"version", "-1"},
                                                        {"first", "2.5"},
                                                        {"frames_per_second", "null"},
                                                        {"frame", "\"x\""}};
  for (const auto& [name, value] : errors) {
    const std::string said = opened_with(name, value);
    EXPECT_NE(said.find(name), std::string::npos) << name << " " << value << ": " << said;
    EXPECT_NE(said.find("wrong.cagewright"), std::string::npos) << said;
  }
  // What is only shown is not worth losing work over.
  const std::pair<const char*, const char*> notes[] = {
      {"symmetry_axis", "-1"}, {"symmetry_axis", "7"}, {"symmetry_axis", "1.5"},
      {"tool", "99"},          {"pivot", "-3"},        {"proportional_radius", "0"},
      {"snap_step", "-1"},     {"snap_scale", "1e99"}};
  for (const auto& [name, value] : notes) {
    const std::string said = opened_with(name, value);
    EXPECT_NE(said.find(name), std::string::npos) << name << " " << value << ": " << said;
    EXPECT_EQ(session_.document().mode(), Mode::deform);
    EXPECT_GE(session_.document().tools().symmetry_axis, 0);
    EXPECT_LE(session_.document().tools().symmetry_axis, 2);
  }
  EXPECT_EQ(opened_with("frame", "5"), "");
}

TEST_F(SessionTest, RecoversWorkOfAProgramThatCrashed) {
  const QDir kept(folder_.filePath("autosave"));
  open_and_bind();
  drag(1, {0, 0, 0.5});
  const std::vector<Vec3> pose = cage();
  {
    Recovery recovery(session_, kept);
    recovery.save();
    const QStringList files = kept.entryList({"*.cagewright"});
    ASSERT_EQ(files.size(), 1);
    EXPECT_TRUE(recovery.abandoned().empty()) << "its own file is not abandoned";
    // A crash leaves the file without its lock.
    QFile::copy(kept.filePath(files[0]), kept.filePath("crashed.cagewright"));
    ASSERT_EQ(recovery.abandoned().size(), 1U);
  }
  EXPECT_EQ(kept.entryList({"*.cagewright"}), QStringList("crashed.cagewright"));
  session_.editor().reset_pose();
  EXPECT_TRUE(
      Recovery::subject_of(kept.filePath("crashed.cagewright")).startsWith("model.obj, not saved"));
  Recovery recovery(session_, kept);
  recovery.recover(kept.filePath("crashed.cagewright"));
  wait();
  EXPECT_EQ(cage(), pose);
  EXPECT_TRUE(session_.modified());
  EXPECT_TRUE(recovery.abandoned().empty()) << "it would be offered again and again";
  EXPECT_EQ(kept.entryList({"*.cagewright"}).size(), 1) << "the work is kept as this program's";
}

TEST_F(SessionTest, TakesEverythingBackAndDoesItAgain) {
  open_and_bind();
  drag(0, {0.1, 0, 0});
  session_.editor().add_pose("a");
  session_.editor().rename_pose(0, "b");
  session_.editor().set_keyframe(3);
  session_.editor().apply_pose(0);
  session_.editor().remove_pose(0);
  session_.editor().refine();
  drag(2, {0, 0.05, 0});
  const std::vector<Vec3> end = cage();
  QUndoStack& stack = session_.editor().undo_stack();
  const int steps = stack.count();
  while (stack.canUndo()) {
    stack.undo();
  }
  EXPECT_TRUE(session_.document().state().poses.empty());
  EXPECT_EQ(session_.document().mode(), Mode::refine) << "binding is taken back, too";
  for (int i = 0; i < steps; ++i) {
    stack.redo();
  }
  EXPECT_EQ(cage(), end);
  EXPECT_EQ(session_.document().mode(), Mode::refine);
  stack.undo();
  stack.undo();
  EXPECT_EQ(session_.document().mode(), Mode::deform);
}

} // namespace
} // namespace cagewright::app
