/* The C interface as a C program meets it: interface_test FOLDER */
#include <cagewright/c/cagewright.h>

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define EXPECT(condition)                                                                          \
  do {                                                                                             \
    if (!(condition)) {                                                                            \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);                              \
      ++failures;                                                                                  \
    }                                                                                              \
  } while (0)

/* The call succeeds; what it says otherwise is printed. */
#define SUCCEEDS(call)                                                                             \
  do {                                                                                             \
    cw_error* error = NULL;                                                                        \
    const cw_code code = (call);                                                                   \
    if (code != CW_OK || error != NULL) {                                                          \
      fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__, cw_name_of_code(code),                \
              cw_error_message(error));                                                            \
      ++failures;                                                                                  \
    }                                                                                              \
    cw_error_free(error);                                                                          \
  } while (0)

/* The call fails with this code, and a sentence that has these words. */
#define FAILS(call, expected, words)                                                               \
  do {                                                                                             \
    cw_error* error = NULL;                                                                        \
    const cw_code code = (call);                                                                   \
    if (code != (expected) || error == NULL || cw_error_code(error) != (expected) ||               \
        strstr(cw_error_message(error), words) == NULL) {                                          \
      fprintf(stderr, "%s:%d: %s, not %s: %s\n", __FILE__, __LINE__, cw_name_of_code(code),        \
              cw_name_of_code(expected), cw_error_message(error));                                 \
      ++failures;                                                                                  \
    }                                                                                              \
    cw_error_free(error);                                                                          \
  } while (0)

/* Quick, rather than good. */
static cw_options* quick_options(void) {
  cw_options* options = cw_options_new();
  SUCCEEDS(cw_options_set(options, "vertices", "60", &error));
  SUCCEEDS(cw_options_set(options, "envelope-resolution", "16", &error));
  SUCCEEDS(cw_options_set(options, "rounds", "1", &error));
  SUCCEEDS(cw_options_set(options, "symmetry", "off", &error));
  return options;
}

static cw_cage* made(const cw_mesh_view* model, const cw_control* control) {
  cw_cage* cage = NULL;
  cw_options* const options = quick_options();
  SUCCEEDS(cw_generate(model, options, control, &cage, &error));
  cw_options_free(options);
  return cage;
}

static int same(const cw_cage* a, const cw_cage* b) {
  const cw_mesh* const x = cw_cage_mesh(a);
  const cw_mesh* const y = cw_cage_mesh(b);
  const size_t count = cw_mesh_vertex_count(x);
  return count == cw_mesh_vertex_count(y) && cw_mesh_corner_count(x) == cw_mesh_corner_count(y) &&
         memcmp(cw_mesh_positions(x), cw_mesh_positions(y), count * 3 * sizeof(double)) == 0 &&
         memcmp(cw_mesh_corners(x), cw_mesh_corners(y),
                cw_mesh_corner_count(x) * sizeof(uint32_t)) == 0;
}

static void tells_what_it_is(void) {
  EXPECT(cw_abi_version() == CW_ABI_VERSION);
  EXPECT(strchr(cw_version(), '.') != NULL);
  EXPECT((strstr(cw_features(), "boxes") != NULL) == (strcmp(cw_licence(), "MIT") != 0));
  EXPECT(strcmp(cw_name_of_code(CW_OK), "ok") == 0);
  EXPECT(strcmp(cw_name_of_code(CW_INTERNAL), "internal") == 0);
  char* options = NULL;
  SUCCEEDS(cw_options_describe(&options, &error));
  EXPECT(strstr(options, "\"max-gap\"") != NULL);
  cw_free(options);
  char* kinds = NULL;
  SUCCEEDS(cw_coordinates_describe(&kinds, &error));
  EXPECT(strstr(kinds, "\"mean_value\"") != NULL);
  cw_free(kinds);
  cw_free(NULL);
  cw_error_free(NULL);
  cw_cage_free(NULL);
}

struct progress {
  int reports;
  double last;
  int falls;
  int stop_at;
  int questions;
};

static int report(void* user, double fraction, const char* step) {
  struct progress* const seen = user;
  seen->falls += fraction < seen->last || fraction < 0 || fraction > 1 || step[0] == '\0';
  seen->last = fraction;
  ++seen->reports;
  return seen->stop_at != 0 && seen->reports >= seen->stop_at;
}

static int yes(void* user) {
  ++((struct progress*)user)->questions;
  return 1;
}

static void makes_cages(const cw_mesh_view* model, const cw_cage* expected) {
  struct progress seen = {0};
  const cw_control control = {sizeof control, 1, report, NULL, &seen, NULL};
  cw_cage* const cage = made(model, &control);
  EXPECT(seen.reports > 2 && seen.falls == 0);
  EXPECT(cw_cage_is_as_asked(cage));
  EXPECT(cw_mesh_vertex_count(cw_cage_mesh(cage)) <= 60);
  EXPECT(strstr(cw_cage_report(cage), "\"volume_ratio\"") != NULL);
  EXPECT(same(cage, expected)); /* made on all cores */
  cw_cage_free(cage);
}

static void judges(const cw_mesh_view* model, const cw_cage* cage) {
  const cw_mesh_view faces = cw_mesh_as_view(cw_cage_mesh(cage));
  cw_verdict* verdict = NULL;
  SUCCEEDS(cw_check(model, &faces, 0, 20, NULL, &verdict, &error));
  EXPECT(cw_verdict_is_valid(verdict));
  EXPECT(strstr(cw_verdict_report(verdict), "\"clearance\"") != NULL);
  cw_verdict_free(verdict);

  SUCCEEDS(cw_check(model, &faces, CW_CHECK_IGNORE_SPECKS, 20, NULL, &verdict, &error));
  EXPECT(cw_verdict_is_valid(verdict)); /* the model has none */
  cw_verdict_free(verdict);

  SUCCEEDS(cw_check(&faces, model, 0, 3, NULL, &verdict, &error)); /* the other way round */
  EXPECT(!cw_verdict_is_valid(verdict));
  EXPECT(strstr(cw_verdict_report(verdict), "\"vertex_outside\"") != NULL);
  cw_verdict_free(verdict);

  char* text = NULL;
  SUCCEEDS(cw_compare(model, &faces, NULL, 1, 0, NULL, &text, &error));
  EXPECT(text != NULL && strstr(text, "cage 1") != NULL);
  cw_free(text);
}

/* All that can be said of a mesh. */
static char* described(const cw_mesh_view* mesh) {
  char* text = NULL;
  SUCCEEDS(cw_info(mesh, 8, NULL, &text, &error));
  EXPECT(text != NULL && strstr(text, "\"genus\"") != NULL);
  return text;
}

/* The same model in other number types, strides and forms of faces. */
static void reads_arrays_where_they_are(const cw_mesh* mesh) {
  const size_t vertices = cw_mesh_vertex_count(mesh);
  const size_t triangles = cw_mesh_triangle_count(mesh);
  const double* const xyz = cw_mesh_positions(mesh);
  const uint32_t* const corners = cw_mesh_triangles(mesh);
  const cw_mesh_view packed = cw_triangle_mesh(xyz, vertices, corners, triangles);
  char* const expected = described(&packed);

  double* const padded = calloc(vertices * 4, sizeof(double));
  double* const columns = calloc(vertices * 3, sizeof(double));
  int64_t* const wide = calloc(triangles * 3, sizeof(int64_t));
  int16_t* const quads = calloc(triangles * 4, sizeof(int16_t));
  uint8_t* const offsets = calloc(triangles + 1, 8);
  for (size_t v = 0; v < vertices; ++v) {
    for (size_t k = 0; k < 3; ++k) {
      padded[4 * v + k] = xyz[3 * v + k];
      columns[k * vertices + v] = xyz[3 * v + k];
    }
  }
  for (size_t t = 0; t < triangles; ++t) {
    for (size_t k = 0; k < 3; ++k) {
      wide[3 * t + k] = corners[3 * t + k];
      quads[4 * t + k] = (int16_t)corners[3 * t + k];
    }
    quads[4 * t + 3] = -1;
  }
  for (size_t t = 0; t <= triangles; ++t) {
    const uint64_t offset = 3 * t;
    memcpy(offsets + 8 * t, &offset, 8);
  }
  const cw_array none = {NULL, CW_UINT64, 0, 0, 0, 0};
  const cw_array by_rows = {padded, CW_FLOAT64, vertices, 3, 4 * sizeof(double), sizeof(double)};
  const cw_array by_columns = {columns, CW_FLOAT64,     vertices,
                               3,       sizeof(double), (ptrdiff_t)(vertices * sizeof(double))};
  const cw_array of_int64 = {wide, CW_INT64, triangles, 3, 0, 0};
  const cw_array of_int16 = {quads, CW_INT16, triangles, 4, 0, 0};
  const cw_array flat = {corners, CW_UINT32, 3 * triangles, 1, 0, 0};
  const cw_array begins = {offsets, CW_UINT64, triangles + 1, 1, 0, 0};
  const cw_array begins_only = {offsets, CW_UINT64, triangles, 1, 0, 0};
  const cw_mesh_view others[] = {{by_rows, of_int64, none},
                                 {by_columns, of_int16, none},
                                 {by_rows, flat, begins},
                                 {by_columns, flat, begins_only}};
  for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
    char* const other = described(&others[i]);
    EXPECT(strcmp(other, expected) == 0);
    cw_free(other);
  }

  cw_cage* none_made = NULL;
  wide[3 * 7 + 1] = 99999;
  FAILS(cw_generate(&others[0], NULL, NULL, &none_made, &error), CW_MALFORMED,
        "the model's faces: row 7 refers to vertex 99999, but there are");
  EXPECT(none_made == NULL);
  wide[3 * 7 + 1] = -1;
  FAILS(cw_generate(&others[0], NULL, NULL, &none_made, &error), CW_MALFORMED, "vertex -1");
  quads[4 * 5 + 2] = -1;
  FAILS(cw_generate(&others[1], NULL, NULL, &none_made, &error), CW_MALFORMED,
        "row 5 has 2 corners; a face has at least 3");
  const cw_array flat_points = {padded, CW_FLOAT64, vertices, 2, 0, 0};
  const cw_mesh_view of_two_columns = {flat_points, of_int64, none};
  FAILS(cw_generate(&of_two_columns, NULL, NULL, &none_made, &error), CW_MALFORMED, "2 columns");
  const cw_mesh_view of_float_faces = {by_rows, by_rows, none};
  FAILS(cw_generate(&of_float_faces, NULL, NULL, &none_made, &error), CW_MALFORMED, "integers");
  const cw_mesh_view nothing = {
      {NULL, CW_FLOAT64, 0, 3, 0, 0}, {NULL, CW_UINT32, 0, 3, 0, 0}, none};
  FAILS(cw_generate(&nothing, NULL, NULL, &none_made, &error), CW_UNFIT_MODEL, "");
  free(padded);
  free(columns);
  free(wide);
  free(quads);
  free(offsets);
  cw_free(expected);
}

static void stops_when_asked(const cw_mesh_view* model) {
  cw_cage* cage = NULL;
  struct progress seen = {0};
  seen.stop_at = 2;
  cw_control control = {sizeof control, 0, report, NULL, &seen, NULL};
  FAILS(cw_generate(model, NULL, &control, &cage, &error), CW_CANCELLED, "cancelled");
  control.report = NULL;
  control.cancelled = yes;
  FAILS(cw_generate(model, NULL, &control, &cage, &error), CW_CANCELLED, "cancelled");
  EXPECT(seen.questions == 1);
  control.cancelled = NULL;
  control.stop = cw_stop_new();
  cw_stop_request(control.stop);
  FAILS(cw_generate(model, NULL, &control, &cage, &error), CW_CANCELLED, "cancelled");
  cw_stop_free(control.stop);
  EXPECT(cage == NULL);
}

static void refuses_options(const cw_mesh_view* model) {
  cw_options* const options = cw_options_new();
  FAILS(cw_options_set(options, "verticces", "60", &error), CW_INVALID_OPTION, "vertices");
  FAILS(cw_options_set(options, "vertices", "three", &error), CW_INVALID_OPTION, "three");
  FAILS(cw_options_set(options, "clearance", "70%", &error), CW_INVALID_OPTION, "clearance");
  EXPECT(cw_options_set(options, "verticces", "60", NULL) == CW_INVALID_OPTION);
  const double weights[] = {1, 2, -1};
  cw_array density = {weights, CW_FLOAT64, 3, 1, 0, 0};
  FAILS(cw_options_set_density(options, &density, &error), CW_MALFORMED, "vertex 2");
  density.rows = 2;
  SUCCEEDS(cw_options_set_density(options, &density, &error));
  cw_cage* cage = NULL;
  FAILS(cw_generate(model, options, NULL, &cage, &error), CW_MISMATCH, "2 weights");
  const double numbers[] = {0, 0, 0, 1, 0, 0};
  const cw_array joints = {numbers, CW_FLOAT64, 2, 3, 0, 0};
  const cw_array along = {numbers, CW_FLOAT64, 1, 3, 0, 0};
  FAILS(cw_options_set_joints(options, &joints, &along, &error), CW_MISMATCH, "2 joints");
  SUCCEEDS(cw_options_set_joints(options, &joints, &joints, &error));
  SUCCEEDS(cw_options_set_joints(options, &joints, NULL, &error));
  cw_options_free(options);
}

static void keeps_the_faces_of_a_cage_given(const cw_mesh_view* model) {
  const double corners[] = {9, 9, 9, -9, -9, 9, -9, 9, -9, 9, -9, -9};
  const int32_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const cw_mesh_view own = {{corners, CW_FLOAT64, 4, 3, 0, 0}, {faces, CW_INT32, 4, 3, 0, 0}, {0}};
  cw_options* const options = cw_options_new();
  SUCCEEDS(cw_options_set_start(options, &own, &error));
  cw_cage* cage = NULL;
  SUCCEEDS(cw_generate(model, options, NULL, &cage, &error));
  EXPECT(strstr(cw_cage_report(cage), "\"method\": \"start\"") != NULL);
  cw_cage_free(cage);
  const cw_mesh_view open = {own.positions, {faces, CW_INT32, 3, 3, 0, 0}, {0}};
  SUCCEEDS(cw_options_set_start(options, &open, &error));
  FAILS(cw_generate(model, options, NULL, &cage, &error), CW_INVALID_CAGE, "open");
  cw_options_free(options);
}

static void deforms(const cw_mesh* mesh, const cw_cage* cage, const char* model_path,
                    const char* folder) {
  const cw_mesh_view model = cw_mesh_as_view(mesh);
  const cw_mesh* const rest = cw_cage_mesh(cage);
  const cw_mesh_view faces = cw_mesh_as_view(rest);
  const size_t vertices = cw_mesh_vertex_count(mesh);
  const size_t corners = cw_mesh_vertex_count(rest);
  const double* const xyz = cw_mesh_positions(mesh);

  double* const weights = calloc(vertices * (corners + 1), sizeof(double));
  SUCCEEDS(cw_coordinates("mean_value", NULL, &model.positions, &faces, NULL, weights, corners + 1,
                          &error));
  double worst = 0;
  for (size_t v = 0; v < vertices; ++v) {
    double point[3] = {0, 0, 0};
    for (size_t c = 0; c < corners; ++c) {
      for (size_t k = 0; k < 3; ++k) {
        point[k] += weights[v * (corners + 1) + c] * cw_mesh_positions(rest)[3 * c + k];
      }
    }
    for (size_t k = 0; k < 3; ++k) {
      worst = fmax(worst, fabs(point[k] - xyz[3 * v + k]));
    }
    EXPECT(weights[v * (corners + 1) + corners] == 0); /* between rows nothing is written */
  }
  EXPECT(worst < 1e-12);
  free(weights);
  size_t columns = 0;
  SUCCEEDS(cw_coordinate_columns("green", "quads=diagonal", &faces, &columns, &error));
  EXPECT(columns > corners);
  FAILS(cw_coordinates("green", NULL, &model.positions, &faces, NULL, NULL, corners, &error),
        CW_INVALID_OPTION, "does not fit");
  FAILS(cw_coordinates("teapot", NULL, &model.positions, &faces, NULL, NULL, 0, &error),
        CW_INVALID_OPTION, "teapot");

  cw_deformer* deformer = NULL;
  SUCCEEDS(cw_deformer_bind(&model, &faces, NULL, NULL, &deformer, &error));
  EXPECT(cw_deformer_vertex_count(deformer) == vertices);
  EXPECT(cw_deformer_cage_vertex_count(deformer) == corners);
  EXPECT(cw_deformer_unbound_count(deformer) == 0);
  EXPECT(cw_deformer_weight_bytes(deformer) >= vertices * corners * 4);
  const double* const positions = cw_deformer_positions(deformer);
  EXPECT(memcmp(positions, xyz, vertices * 3 * sizeof(double)) == 0);
  double* const moved = malloc(corners * 3 * sizeof(double));
  memcpy(moved, cw_mesh_positions(rest), corners * 3 * sizeof(double));
  for (size_t c = 0; c < corners; ++c) {
    moved[3 * c] += 1.5;
  }
  cw_array to = cw_points(moved, corners);
  SUCCEEDS(cw_deformer_set_cage(deformer, &to, NULL, &error));
  EXPECT(cw_deformer_positions(deformer) == positions);
  EXPECT(fabs(positions[0] - xyz[0] - 1.5) < 1e-6);
  const double* const normals = cw_deformer_normals(deformer);
  EXPECT(normals != NULL && fabs(normals[0] * normals[0] + normals[1] * normals[1] +
                                 normals[2] * normals[2] - 1) < 1e-9);
  to.rows = corners - 1;
  FAILS(cw_deformer_set_cage(deformer, &to, NULL, &error), CW_MISMATCH, "not");
  const uint8_t one = 3;
  const cw_array which = {&one, CW_UINT8, 1, 1, 0, 0};
  to = cw_points(moved + 9, 1);
  moved[9] += 1;
  SUCCEEDS(cw_deformer_move(deformer, &which, &to, NULL, &error));
  EXPECT(cw_deformer_cage_positions(deformer)[9] == moved[9]);
  const uint32_t beyond = (uint32_t)corners;
  const cw_array nothing = {&beyond, CW_UINT32, 1, 1, 0, 0};
  FAILS(cw_deformer_move(deformer, &nothing, &to, NULL, &error), CW_MALFORMED, "refers to vertex");
  cw_deformer_free(deformer);

  char cage_path[4096];
  char posed_path[4096];
  char out_path[4096];
  snprintf(cage_path, sizeof cage_path, "%s/cage.obj", folder);
  snprintf(posed_path, sizeof posed_path, "%s/posed.obj", folder);
  snprintf(out_path, sizeof out_path, "%s/moved.obj", folder);
  SUCCEEDS(cw_write_mesh(&faces, cage_path, &error));
  cw_mesh_view posed = faces;
  posed.positions = cw_points(moved, corners);
  SUCCEEDS(cw_write_mesh(&posed, posed_path, &error));
  char* notes = NULL;
  SUCCEEDS(cw_deform_file(model_path, cage_path, posed_path, out_path, NULL, &notes, &error));
  EXPECT(notes != NULL && notes[0] == '[');
  cw_free(notes);
  cw_mesh* result = NULL;
  SUCCEEDS(cw_read_mesh(out_path, CW_POSE_SHOWN, &result, &error));
  EXPECT(cw_mesh_vertex_count(result) == vertices);
  EXPECT(cw_mesh_positions(result)[0] != xyz[0]);
  cw_mesh_free(result);
  const char* const twice[] = {posed_path, posed_path};
  const cw_sequence_options times = {sizeof(cw_sequence_options), NULL, NULL, 25, 1};
  char cache_path[4096];
  snprintf(cache_path, sizeof cache_path, "%s/moved.pc2", folder);
  const char* const cache = cache_path;
  SUCCEEDS(cw_deform_sequence(model_path, cage_path, twice, NULL, 2, &cache, 1, &times, NULL, NULL,
                              &error));
  const char* const single = out_path;
  FAILS(cw_deform_sequence(model_path, cage_path, twice, NULL, 2, &single, 1, NULL, NULL, NULL,
                           &error),
        CW_UNSUPPORTED, "holds one pose");
  FAILS(cw_deform_file(model_path, cage_path, posed_path, cage_path, NULL, NULL, &error),
        CW_CANNOT_WRITE, "written over");
  free(moved);
}

static void reads_and_refuses_files(void) {
  cw_mesh* mesh = NULL;
  FAILS(cw_read_mesh("/nowhere/model.obj", CW_POSE_SHOWN, &mesh, &error), CW_CANNOT_OPEN,
        "/nowhere/model.obj");
  EXPECT(mesh == NULL);
  const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n";
  SUCCEEDS(cw_parse_mesh(text, strlen(text), NULL, NULL, CW_POSE_SHOWN, &mesh, &error));
  EXPECT(cw_mesh_vertex_count(mesh) == 4 && cw_mesh_face_count(mesh) == 2);
  EXPECT(cw_mesh_corner_count(mesh) == 7 && cw_mesh_triangle_count(mesh) == 3);
  EXPECT(cw_mesh_offsets(mesh)[2] == 7 && cw_mesh_face_of_triangle(mesh)[2] == 1);
  EXPECT(cw_mesh_colors(mesh) == NULL && cw_mesh_face_groups(mesh) == NULL);
  EXPECT(strcmp(cw_mesh_group_name(mesh, 3), "") == 0);
  cw_mesh_free(mesh);
  FAILS(cw_parse_mesh(text, strlen(text), "stl", "a.stl", CW_POSE_SHOWN, &mesh, &error),
        CW_MALFORMED, "a.stl");
  FAILS(cw_parse_mesh(text, strlen(text), "xyz", NULL, CW_POSE_SHOWN, &mesh, &error),
        CW_UNSUPPORTED, "xyz");
}

static void draws(const cw_mesh_view* model) {
  cw_image* image = NULL;
  double view[2] = {0, 0};
  if (strstr(cw_features(), "render") == NULL) {
    FAILS(cw_render(model, NULL, NULL, &image, &error), CW_NOT_AVAILABLE, "without pictures");
    return;
  }
  EXPECT(cw_view_named("left", view) && view[0] != 0);
  EXPECT(!cw_view_named("inside", view));
  cw_render_options options = {0};
  options.size = sizeof options;
  options.width = 64;
  options.height = 48;
  options.views = view;
  options.view_count = 1;
  SUCCEEDS(cw_render(model, model, &options, &image, &error));
  EXPECT(cw_image_width(image) == 64 && cw_image_height(image) == 48);
  EXPECT(cw_image_pixels(image)[3] == 255);
  cw_image_free(image);
  options.width = -1;
  FAILS(cw_render(model, NULL, &options, &image, &error), CW_INVALID_OPTION, "pixels");
}

struct job {
  const cw_mesh_view* model;
  cw_cage* cage;
};

static void* run(void* data) {
  struct job* const job = data;
  const cw_control control = {sizeof control, 1, NULL, NULL, NULL, NULL};
  job->cage = made(job->model, &control);
  return NULL;
}

static void is_for_many_threads(const cw_mesh_view* model, const cw_cage* expected) {
  struct job jobs[2] = {{model, NULL}, {model, NULL}};
  pthread_t threads[2];
  for (int i = 0; i < 2; ++i) {
    pthread_create(&threads[i], NULL, run, &jobs[i]);
  }
  for (int i = 0; i < 2; ++i) {
    pthread_join(threads[i], NULL);
  }
  EXPECT(same(jobs[0].cage, expected) && same(jobs[1].cage, expected));
  cw_cage_free(jobs[0].cage);
  cw_cage_free(jobs[1].cage);
}

/* A ring of 24 x 12 vertices, thicker on one side, as a file. */
static void write_ring(const char* path) {
  enum { around = 24, across = 12 };
  static double xyz[around * across * 3];
  static uint32_t quads[around * across * 4];
  for (uint32_t i = 0; i < around; ++i) {
    for (uint32_t j = 0; j < across; ++j) {
      const double a = 6.283185307179586 * i / around;
      const double b = 6.283185307179586 * j / across;
      const double thickness = 0.3 + 0.1 * cos(a);
      double* const p = xyz + 3 * (i * across + j);
      p[0] = (1 + thickness * cos(b)) * cos(a);
      p[1] = (1 + thickness * cos(b)) * sin(a);
      p[2] = thickness * sin(b);
      const uint32_t next_i = (i + 1) % around;
      const uint32_t next_j = (j + 1) % across;
      uint32_t* const q = quads + 4 * (i * across + j);
      q[0] = i * across + j;
      q[1] = next_i * across + j;
      q[2] = next_i * across + next_j;
      q[3] = i * across + next_j;
    }
  }
  const cw_mesh_view ring = {cw_points(xyz, around * across),
                             {quads, CW_UINT32, around * across, 4, 0, 0},
                             {NULL, CW_UINT64, 0, 0, 0, 0}};
  SUCCEEDS(cw_write_mesh(&ring, path, &error));
}

int main(int argc, char** argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: interface_test FOLDER\n");
    return 2;
  }
  tells_what_it_is();
  reads_and_refuses_files();
  char path[4096];
  snprintf(path, sizeof path, "%s/ring.obj", argv[1]);
  write_ring(path);
  cw_mesh* mesh = NULL;
  SUCCEEDS(cw_read_mesh(path, CW_POSE_SHOWN, &mesh, &error));
  if (mesh != NULL) {
    const cw_mesh_view model = cw_mesh_as_view(mesh);
    cw_cage* const cage = made(&model, NULL);
    makes_cages(&model, cage);
    judges(&model, cage);
    reads_arrays_where_they_are(mesh);
    stops_when_asked(&model);
    refuses_options(&model);
    keeps_the_faces_of_a_cage_given(&model);
    deforms(mesh, cage, path, argv[1]);
    draws(&model);
    is_for_many_threads(&model, cage);
    cw_cage_free(cage);
  }
  cw_mesh_free(mesh);
  if (failures == 0) {
    printf("the C interface does what it says\n");
  }
  return failures == 0 ? 0 : 1;
}
