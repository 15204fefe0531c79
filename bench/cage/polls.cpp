// How long generate() works without asking whether to stop, and how steady its progress is:
//
//   polls MODEL [OPTION VALUE]...     options as on the command line, without dashes
//
// Seconds are those of the process on all its processors.
#include "support/polls.h"
#include <cagewright/cage/generate.h>
#include <cagewright/cage/option_table.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <cstdio>

using namespace cagewright;

int main(int argc, char** argv) {
  if (argc < 2 || argc % 2 != 0) {
    std::fprintf(stderr, "usage: polls MODEL [OPTION VALUE]...\n");
    return 2;
  }
  const Result<PolygonMesh> model = read_mesh(argv[1]);
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message.c_str());
    return 2;
  }
  GenerateOptions options;
  for (int i = 2; i + 1 < argc; i += 2) {
    const CageOption* option = find_cage_option(argv[i]);
    const Status set = option != nullptr ? set_from_text(*option, argv[i + 1], options)
                                         : Error{ErrorCode::invalid_option, "no such option"};
    if (!set) {
      std::fprintf(stderr, "%s: %s\n", argv[i], set.error().message.c_str());
      return 2;
    }
  }
  test::Polls polls;
  const Result<GeneratedCage> made = generate(to_triangle_mesh(*model), options, polls.progress());
  polls.end();
  std::printf("%s: %s, %.2f s, %zu questions\n", argv[1],
              made ? "made" : made.error().message.c_str(), polls.seconds(), polls.count());
  for (const test::Stretch& stretch : polls.longest()) {
    std::printf("  %7.3f s  %s\n", stretch.seconds, stretch.step.c_str());
  }
  double next = 0;
  for (const auto& shown : polls.shown()) {
    if (shown.seconds >= next * polls.seconds()) {
      std::printf("  after %5.1f %% of the work %5.1f %% shown  %s\n",
                  100 * shown.seconds / polls.seconds(), 100 * shown.fraction, shown.step.c_str());
      next = shown.seconds / polls.seconds() + 0.04;
    }
  }
  return 0;
}
