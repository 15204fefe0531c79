#include <cagewright/cage/generate.h>

#include "mesh/shapes.h"
#include <cagewright/cage/option_table.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {
namespace {

// Quick to make a cage of.
GenerateOptions quick(int vertices) {
  GenerateOptions options;
  options.vertices = vertices;
  options.rounds = 0;
  options.resolution = 24;
  options.depth = 2;
  return options;
}

TEST(Generate, MakesAHundredVerticesUnlessToldOtherwise) {
  EXPECT_EQ(vertex_limit({}), 100);
  EXPECT_EQ(vertex_limit({.vertices = 60, .max_gap = 0.01}), 60);
  EXPECT_EQ(vertex_limit({.faces = 300}), 0);
  EXPECT_EQ(vertex_limit({.max_gap = 0.01}), 0);
}

TEST(Generate, CountsTheSurfacesThatBoxesMake) {
  TriangleMesh model = make_cube();
  const TriangleMesh cube = model;
  for (const Vec3& p : cube.positions) {
    model.positions.push_back(p + Vec3(20, 0, 0));
  }
  for (const Triangle& t : cube.triangles) {
    model.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  GenerateOptions options = quick(40);
  options.method = Method::boxes;
  options.pieces = Pieces::apart;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->pieces, 2);
  EXPECT_TRUE(validate_cage(made->faces, model, {.allow_pieces = made->pieces > 1})->valid());
}

TEST(Generate, SaysHowTheCageWasMade) {
  const TriangleMesh model = make_torus(0.3, 24, 12);
  for (const Method method : {Method::envelope, Method::boxes, Method::boxes_improved}) {
    GenerateOptions options = quick(40);
    options.method = method;
    const Result<GeneratedCage> made = generate(model, options);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->method, method);
    EXPECT_TRUE(made->is_as_asked()) << made->remarks.front().message;
    EXPECT_TRUE(validate_cage(made->faces, model)->valid());
    EXPECT_EQ(made->figures.vertices, made->faces.positions.size());
    EXPECT_EQ(made->faces.positions, made->triangles.positions);
    EXPECT_EQ(made->boxes.empty(), method == Method::envelope);
    EXPECT_EQ(made->box_tree == nullptr, method == Method::envelope);
    EXPECT_EQ(made->resolution > 0, method == Method::envelope);
    EXPECT_EQ(made->mirror.has_value(), method != Method::boxes);
    EXPECT_EQ(made->clearance, method == Method::boxes ? 0 : options.clearance);
    EXPECT_FALSE(made->times.empty());
  }
}

TEST(Generate, TellsWhatIsNotAsAskedFor) {
  const TriangleMesh model = make_torus(0.2, 48, 24);
  GenerateOptions options = quick(5); // a torus needs seven
  options.method = Method::boxes_improved;
  const Result<GeneratedCage> few = generate(model, options);
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_FALSE(few->is_as_asked());
  EXPECT_EQ(few->remarks.front().reason, Reason::budget_not_reached);
  EXPECT_TRUE(validate_cage(few->faces, model)->valid());

  options = quick(20);
  options.max_gap = 0.004;
  const Result<GeneratedCage> near = generate(model, options);
  ASSERT_TRUE(near) << near.error().message;
  EXPECT_FALSE(near->is_as_asked());
  EXPECT_EQ(near->remarks.front().reason, Reason::gap_not_kept);

  TriangleMesh lopsided = make_icosphere(2);
  for (Vec3& p : lopsided.positions) {
    p += Vec3(0.3 * p.y() * p.y() * p.z(), 0.4 * p.z() * p.x(), 0.2 * p.x() * p.y() * p.z());
  }
  const Result<GeneratedCage> plain = generate(lopsided, quick(30));
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_TRUE(plain->is_as_asked()); // automatic: if the model is its own mirror image
  EXPECT_EQ(plain->mirror.has_value(), plain->remarks.empty());
}

TEST(Generate, NamesTheVertexThatIsNowhere) {
  TriangleMesh model = joined(make_cube(), make_tetrahedron()); // pieces are looked at first
  model.positions[9].y() = std::numeric_limits<double>::quiet_NaN();
  const Result<GeneratedCage> made = generate(model, quick(30));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::unfit_model);
  EXPECT_TRUE(made.error().message.starts_with("vertex 9 of the model has a coordinate"))
      << made.error().message;
}

TEST(Generate, RefusesWhatIsOutOfRange) {
  const TriangleMesh model = make_cube();
  for (const GenerateOptions& options :
       {GenerateOptions{.vertices = 3}, GenerateOptions{.vertices = 0},
        GenerateOptions{.faces = -1}, GenerateOptions{.clearance = 0},
        GenerateOptions{.closing = 0.6}, GenerateOptions{.envelope_resolution = 3},
        GenerateOptions{.depth = 99}, GenerateOptions{.eta = 0},
        GenerateOptions{.max_gap = 0.002}}) {
    const Result<GeneratedCage> made = generate(model, options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::invalid_option) << made.error().message;
    EXPECT_EQ(made.error().message.find("--"), std::string::npos) << made.error().message;
  }
}

TEST(OptionTable, DeclaresEveryOptionOnceWithHelp) {
  std::set<std::string_view> names;
  for (const CageOption& option : cage_options()) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name;
    EXPECT_TRUE(option.help.ends_with('.')) << option.name;
    EXPECT_FALSE(option.label.empty());
    EXPECT_EQ(option.help.find("--"), std::string_view::npos) << option.name;
    EXPECT_EQ(find_cage_option(option.name), &option);
  }
  EXPECT_EQ(find_cage_option("none"), nullptr);
  EXPECT_TRUE(check_ranges({}));
}

TEST(OptionTable, ReadsWhatItWrites) {
  for (const CageOption& option : cage_options()) {
    std::set<std::string> texts; // a few values of each
    if (const auto* choice = std::get_if<ChoiceOption>(&option.kind)) {
      for (const OptionWord& word : choice->words) {
        texts.emplace(word.word);
      }
    } else if (const auto* integer = std::get_if<IntegerOption>(&option.kind)) {
      texts = {std::to_string(integer->least), std::to_string(integer->most)};
    } else {
      texts = {"0.25"};
    }
    for (const std::string& text : texts) {
      GenerateOptions options;
      ASSERT_TRUE(set_from_text(option, text, options)) << option.name << ' ' << text;
      EXPECT_TRUE(check_ranges(options));
      GenerateOptions again;
      ASSERT_TRUE(set_from_text(option, text_of(option, options), again)) << option.name;
      EXPECT_EQ(text_of(option, again), text_of(option, options));
    }
    for (const char* text : {"", "nonsense", "1e999", "-1", "nan", "3 ", "1%%"}) {
      GenerateOptions options;
      const Status status = set_from_text(option, text, options);
      ASSERT_FALSE(status) << option.name << ' ' << text;
      EXPECT_EQ(status.error().code, ErrorCode::invalid_option);
      EXPECT_NE(status.error().message.find(values_of(option)), std::string::npos);
    }
  }
}

TEST(OptionTable, TakesPerCentForLengths) {
  GenerateOptions options;
  for (const char* name : {"clearance", "max-gap", "closing"}) {
    const CageOption& option = *find_cage_option(name);
    ASSERT_TRUE(set_from_text(option, "0.5%", options));
    EXPECT_EQ(text_of(option, options), "0.5%");
    EXPECT_EQ(options.*std::get<NumberOption>(option.kind).member, 0.005);
    EXPECT_FALSE(set_from_text(option, "51%", options));
  }
  EXPECT_FALSE(set_from_text(*find_cage_option("eta"), "50%", options));
}

} // namespace
} // namespace cagewright
