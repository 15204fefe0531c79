/// \file
/// Cagewright for C, and for whatever can call C: Python, Blender, game engines.
///
/// Link with libcagewright.so (pkg-config cagewright-c). The library never prints, never exits,
/// reads no environment and keeps no state between calls. Any number of threads may call it, each
/// with objects of its own; one object is for one thread at a time, but may be read by several.
///
/// What every function has in common:
///  - No argument makes the library crash: what is NULL and may not be is CW_MALFORMED; functions
///    that cannot fail give 0, NULL or "" for NULL. (Memory that an array says it has must be
///    there.)
///  - Failures are cw_code values other than CW_OK. The last argument, `error`, may be NULL; else
///    it receives a sentence for people, to be freed with cw_error_free(), or NULL on success.
///  - Results come through a pointer (`out`) and are freed by the function of their kind; NULL may
///    be freed. On failure they are set to NULL.
///  - Arrays that are passed in are read where they are, whatever their number type and strides,
///    and only during the call. Positions as packed doubles and triangles as packed 32-bit indices
///    are used without a copy. Arrays that are handed out belong to the object they come from.
///  - Indices are counted from 0. Text is UTF-8, JSON included.
///  - `control` may be NULL: all cores, in silence, to the end.
#ifndef CAGEWRIGHT_C_CAGEWRIGHT_H
#define CAGEWRIGHT_C_CAGEWRIGHT_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#if defined(CW_BUILDING)
#define CW_API __declspec(dllexport)
#else
#define CW_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define CW_API __attribute__((visibility("default")))
#else
#define CW_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- The library ----------------------------------------------------------------------------- */

/// Rises when something that stands in this header changes its meaning or goes away; never when
/// something is added.
#define CW_ABI_VERSION 1

/// The ABI of the library that is loaded: to be compared with CW_ABI_VERSION.
CW_API int cw_abi_version(void);

/// "0.1.0"
CW_API const char* cw_version(void);

/// What this library was built with: "boxes" and "render", separated by a blank; may be empty.
CW_API const char* cw_features(void);

/// The licence that binds who uses it: "GPL-3.0-or-later" with boxes, else "MIT".
CW_API const char* cw_licence(void);

/// Frees text that functions hand out. NULL is allowed.
CW_API void cw_free(char* text);

/* ---- Failures -------------------------------------------------------------------------------- */

typedef enum cw_code {
  CW_OK = 0,
  CW_CANNOT_OPEN = 1,    ///< the file is missing, is not a file, or may not be read
  CW_CANNOT_WRITE = 2,   ///< the output cannot be created or completed
  CW_MALFORMED = 3,      ///< the content of a file or an array makes no sense
  CW_UNSUPPORTED = 4,    ///< a format, or a feature of it, that is neither read nor written
  CW_TOO_LARGE = 5,      ///< more memory or larger indices are needed than there are
  CW_UNFIT_MODEL = 6,    ///< the model has no extent to build a cage around
  CW_INVALID_CAGE = 7,   ///< the cage is not what is needed (open, self-intersecting)
  CW_INVALID_OPTION = 8, ///< out of its range, unknown, or two contradict each other
  CW_NO_VALID_CAGE = 9,  ///< no cage could be found that passes the exact check
  CW_MISMATCH = 10,      ///< two inputs that belong together do not
  CW_NOT_AVAILABLE = 11, ///< the machine or this build lacks something
  CW_CANCELLED = 12,     ///< the caller asked to stop
  CW_INTERNAL = 13       ///< a fault of the library
} cw_code;

/// "cannot_open"; "ok" for CW_OK.
CW_API const char* cw_name_of_code(cw_code code);

typedef struct cw_error cw_error;
CW_API cw_code cw_error_code(const cw_error* error);
/// One sentence: what is wrong, where, and what helps.
CW_API const char* cw_error_message(const cw_error* error);
CW_API void cw_error_free(cw_error* error);

/* ---- How a call runs ------------------------------------------------------------------------- */

/// A wish to stop, from any thread or from a signal handler.
typedef struct cw_stop cw_stop;
CW_API cw_stop* cw_stop_new(void); ///< NULL: no memory
CW_API void cw_stop_request(cw_stop* stop);
CW_API void cw_stop_free(cw_stop* stop); ///< not while a call uses it

/// All members may be 0. A call that is asked to stop ends with CW_CANCELLED within about a tenth
/// of a second, and leaves its inputs as they were.
typedef struct cw_control {
  size_t size; ///< sizeof(cw_control)
  int threads; ///< at most so many; 0: all cores. Results do not depend on it
  /// Called with a fraction in [0, 1] that never falls, and the name of the step under way. Any
  /// thread may call it, one at a time. Not 0: stop.
  int (*report)(void* user, double fraction, const char* step);
  /// Asked some twenty times a second, on a thread of the library's own. Not 0: stop.
  int (*cancelled)(void* user);
  void* user; ///< handed to the two
  cw_stop* stop;
} cw_control;

/* ---- Arrays and meshes ----------------------------------------------------------------------- */

typedef enum cw_type {
  CW_FLOAT64 = 0,
  CW_FLOAT32 = 1,
  CW_INT8 = 2,
  CW_UINT8 = 3,
  CW_INT16 = 4,
  CW_UINT16 = 5,
  CW_INT32 = 6,
  CW_UINT32 = 7,
  CW_INT64 = 8,
  CW_UINT64 = 9
} cw_type;

/// Numbers in rows and columns, in someone else's memory. Strides are in bytes, may be negative,
/// and are those from row to row and from column to column; both 0 means packed, row after row.
typedef struct cw_array {
  const void* data; ///< the first number
  cw_type type;
  size_t rows;
  size_t columns;
  ptrdiff_t row_stride;
  ptrdiff_t column_stride;
} cw_array;

/// A mesh in someone else's memory.
///
/// Faces are one of
///  - rows of 3, 4 or more corners, counter-clockwise from outside: F x K; a negative corner ends
///    its face (a triangle among quads: 7 8 9 -1);
///  - with `offsets` (F + 1, or F where the last is left out) all corners one after the other in
///    one column: face f has those from offsets[f] on, before offsets[f + 1].
typedef struct cw_mesh_view {
  cw_array positions; ///< V x 3
  cw_array faces;
  cw_array offsets; ///< data NULL: faces are rows
} cw_mesh_view;

/// A mesh of the library's own: V vertices, F faces with C corners, T triangles.
typedef struct cw_mesh cw_mesh;
CW_API void cw_mesh_free(cw_mesh* mesh);
CW_API size_t cw_mesh_vertex_count(const cw_mesh* mesh);
CW_API size_t cw_mesh_face_count(const cw_mesh* mesh);
CW_API size_t cw_mesh_corner_count(const cw_mesh* mesh);
CW_API size_t cw_mesh_triangle_count(const cw_mesh* mesh);
CW_API const double* cw_mesh_positions(const cw_mesh* mesh);          ///< V x 3
CW_API const uint32_t* cw_mesh_corners(const cw_mesh* mesh);          ///< C, face after face
CW_API const uint64_t* cw_mesh_offsets(const cw_mesh* mesh);          ///< F + 1, into the corners
CW_API const uint32_t* cw_mesh_triangles(const cw_mesh* mesh);        ///< T x 3: the faces, cut
CW_API const uint32_t* cw_mesh_face_of_triangle(const cw_mesh* mesh); ///< T
CW_API const float* cw_mesh_colors(const cw_mesh* mesh);              ///< V x 4 in [0, 1], or NULL
CW_API size_t cw_mesh_group_count(const cw_mesh* mesh); ///< objects and groups of the file
CW_API const char* cw_mesh_group_name(const cw_mesh* mesh, size_t group);
CW_API const uint32_t* cw_mesh_face_groups(const cw_mesh* mesh); ///< F, or NULL
/// What was read otherwise than it stands in the file: a JSON array of {"code", "message"}.
CW_API const char* cw_mesh_notes(const cw_mesh* mesh);
/// The mesh as an argument. It lives as long as the mesh.
CW_API cw_mesh_view cw_mesh_as_view(const cw_mesh* mesh);

/// Positions of a rigged glTF model: as a viewer shows it, or as it was bound to its joints.
typedef enum cw_pose { CW_POSE_SHOWN = 0, CW_POSE_BIND = 1 } cw_pose;

/// Reads an OBJ, PLY, STL, OFF, GLB or glTF file. Vertices and faces keep the order of the file.
CW_API cw_code cw_read_mesh(const char* path, cw_pose pose, cw_mesh** out, cw_error** error);

/// The same for a file in memory.
/// \param format  "obj", "ply", "stl", "off" or "gltf"; NULL: by the content, else OBJ
/// \param name    stands for the file in messages; may be NULL
CW_API cw_code cw_parse_mesh(const void* bytes, size_t size, const char* format, const char* name,
                             cw_pose pose, cw_mesh** out, cw_error** error);

/// Writes an OBJ, PLY, STL, OFF, GLB or glTF file, by the extension. Reading it gives the same
/// doubles, but for glTF, which holds floats and triangles. It appears under its name only when
/// complete.
CW_API cw_code cw_write_mesh(const cw_mesh_view* mesh, const char* path, cw_error** error);

/* ---- Cages ----------------------------------------------------------------------------------- */

/// What is asked of a cage. New ones have the defaults.
typedef struct cw_options cw_options;
CW_API cw_options* cw_options_new(void); ///< NULL: no memory
CW_API void cw_options_free(cw_options* options);

/// Sets an option by its name on the command line, to what a person would write there: "vertices"
/// to "60", "max-gap" to "2%" or "0.02", "quads" to "on", "method" to "boxes-improved".
CW_API cw_code cw_options_set(cw_options* options, const char* name, const char* value,
                              cw_error** error);

/// Where the cage is to be finer: a weight above 0 for each vertex of the model (V x 1). Four times
/// the weight makes edges half as long. The numbers are copied.
CW_API cw_code cw_options_set_density(cw_options* options, const cw_array* weights,
                                      cw_error** error);

/// Where limbs bend: a ring of edges goes round the limb at each of J points (J x 3).
/// \param along  J x 3, towards where each limb goes on, of any length, zero: not known; or NULL
/// The numbers are copied.
CW_API cw_code cw_options_set_joints(cw_options* options, const cw_array* joints,
                                     const cw_array* along, cw_error** error);

/// A cage of one's own: its vertices are moved until it is valid and tight, its faces and the order
/// of its vertices stay. Of the other options only the clearance and the density are heeded then.
/// The numbers are copied.
CW_API cw_code cw_options_set_start(cw_options* options, const cw_mesh_view* cage,
                                    cw_error** error);

/// All options: a JSON array of {"name", "label", "help", "group", "values", "default"}. To be
/// freed with cw_free().
CW_API cw_code cw_options_describe(char** out, cw_error** error);

/// A cage that is proved valid.
typedef struct cw_cage cw_cage;
CW_API void cw_cage_free(cw_cage* cage);
CW_API const cw_mesh* cw_cage_mesh(const cw_cage* cage); ///< lives as long as the cage
/// The report of `cagewright generate --json`: options, figures, symmetry, remarks, times.
CW_API const char* cw_cage_report(const cw_cage* cage);
/// Whether all that was asked for holds; if not, "remarks" of the report says why.
CW_API int cw_cage_is_as_asked(const cw_cage* cage);

/// Makes a cage round a model: closed, manifold, without self-intersections, every vertex of the
/// model strictly inside, no face of the model touching it; decided exactly on the doubles that are
/// returned. The model may be open, inverted, self-intersecting or in pieces.
/// \param options  NULL: the defaults, a cage of 100 vertices
CW_API cw_code cw_generate(const cw_mesh_view* model, const cw_options* options,
                           const cw_control* control, cw_cage** out, cw_error** error);

/// A verdict on a cage.
typedef struct cw_verdict cw_verdict;
CW_API void cw_verdict_free(cw_verdict* verdict);
CW_API int cw_verdict_is_valid(const cw_verdict* verdict);
/// The report of `cagewright check --json`: counts, violations with places and remedies, figures.
CW_API const char* cw_verdict_report(const cw_verdict* verdict);

typedef enum cw_check_flags {
  CW_CHECK_PIECES = 1,       ///< accept several closed pieces
  CW_CHECK_INNER_SHELLS = 2, ///< accept closed pieces within others, oriented inward
  CW_CHECK_IGNORE_SPECKS = 4 ///< judge for the model without tiny pieces far from the rest, and
                             ///< without vertices that no face uses: as with "ignore-specks"
} cw_check_flags;

/// Judges a cage, exactly. Vertices at equal positions are judged merged.
/// \param flags       of cw_check_flags, added
/// \param max_listed  violations of each kind to list; all are counted
CW_API cw_code cw_check(const cw_mesh_view* model, const cw_mesh_view* cage, int flags,
                        size_t max_listed, const cw_control* control, cw_verdict** out,
                        cw_error** error);

/// Figures of cages of a model, valid or not, and how well each bends and twists it: a JSON array,
/// an object for each cage, as in `cagewright compare --json`.
/// \param names      what each cage is called in the result; NULL: "cage 1", ...
/// \param poses      0: leave out the bend and the twist, which take longest
CW_API cw_code cw_compare(const cw_mesh_view* model, const cw_mesh_view* cages,
                          const char* const* names, size_t count, int poses,
                          const cw_control* control, char** out, cw_error** error);

/// Counts, topology, defects, sizes, boxes and mirror plane of a model: JSON as of
/// `cagewright info --json`.
/// \param resolution  voxels along the longest axis, for the box of vertices and voxels; 0: 64
CW_API cw_code cw_info(const cw_mesh_view* model, int resolution, const cw_control* control,
                       char** out, cw_error** error);

/* ---- Deformation ----------------------------------------------------------------------------- */

/// How much each of P points follows each of K columns: those of the C cage vertices, and for some
/// kinds of coordinates more behind them, such as one for the normal of each face.
///
/// \param kind      of coordinates, as `cagewright coordinates` lists them; NULL: "mean_value", of
///                  which K = C
/// \param settings  of that kind, "quads=diagonal outside=rest"; NULL: as they are by themselves
/// \param points    P x 3
/// \param weights   P rows of K doubles to be written
/// \param row       doubles from one row to the next; 0: K
CW_API cw_code cw_coordinates(const char* kind, const char* settings, const cw_array* points,
                              const cw_mesh_view* cage, const cw_control* control, double* weights,
                              size_t row, cw_error** error);

/// A matrix of which only what is not 0 is kept, row after row: as scipy's csr_matrix.
typedef struct cw_sparse cw_sparse;
CW_API void cw_sparse_free(cw_sparse* matrix);
CW_API size_t cw_sparse_row_count(const cw_sparse* matrix);
CW_API size_t cw_sparse_column_count(const cw_sparse* matrix);
CW_API size_t cw_sparse_value_count(const cw_sparse* matrix);      ///< N
CW_API const double* cw_sparse_values(const cw_sparse* matrix);    ///< N
CW_API const uint32_t* cw_sparse_columns(const cw_sparse* matrix); ///< N: the column of each value
CW_API const uint64_t* cw_sparse_offsets(const cw_sparse* matrix); ///< rows + 1, into the values

/// What cw_coordinates() gives, P x K, without the zeros; all of it is never in memory at once.
CW_API cw_code cw_coordinates_sparse(const char* kind, const char* settings, const cw_array* points,
                                     const cw_mesh_view* cage, const cw_control* control,
                                     cw_sparse** out, cw_error** error);

/// K, the columns that cw_coordinates() writes for a cage.
CW_API cw_code cw_coordinate_columns(const char* kind, const char* settings,
                                     const cw_mesh_view* cage, size_t* columns, cw_error** error);

/// All kinds of coordinates: JSON as of `cagewright coordinates --json`, {"default", "kinds"}, each
/// kind with "name", "idea", "options" and more. To be freed with cw_free().
CW_API cw_code cw_coordinates_describe(char** out, cw_error** error);

/// A model bound to a cage, for moving it again and again.
typedef struct cw_deformer cw_deformer;

typedef enum cw_storage {
  CW_STORAGE_SINGLE = 0, ///< weights as floats
  CW_STORAGE_FULL = 1,   ///< as doubles
  CW_STORAGE_COMPACT = 2 ///< in 16 bits
} cw_storage;

typedef struct cw_deformer_options {
  size_t size;             ///< sizeof(cw_deformer_options)
  const char* coordinates; ///< the kind; NULL: "mean_value"
  const char* settings;    ///< of that kind; NULL: as they are by themselves
  cw_storage storage;
  int no_normals; ///< do not keep normals up to date
  int allow_open; ///< accept a cage with open edges, with weights that do not reproduce the points
} cw_deformer_options;

/// Binds a model of P vertices to a cage of C. \param options  NULL: all 0
CW_API cw_code cw_deformer_bind(const cw_mesh_view* model, const cw_mesh_view* cage,
                                const cw_deformer_options* options, const cw_control* control,
                                cw_deformer** out, cw_error** error);
CW_API void cw_deformer_free(cw_deformer* deformer);

/// Moves all vertices of the cage (C x 3), and the model with them.
CW_API cw_code cw_deformer_set_cage(cw_deformer* deformer, const cw_array* positions,
                                    const cw_control* control, cw_error** error);
/// Moves some of them: `vertices` (k x 1) to `positions` (k x 3). Costs k / C of moving all.
CW_API cw_code cw_deformer_move(cw_deformer* deformer, const cw_array* vertices,
                                const cw_array* positions, const cw_control* control,
                                cw_error** error);

CW_API size_t cw_deformer_vertex_count(const cw_deformer* deformer);      ///< P
CW_API size_t cw_deformer_cage_vertex_count(const cw_deformer* deformer); ///< C
/// P x 3, where the model is now. The address stays; the numbers change when the cage moves.
CW_API const double* cw_deformer_positions(const cw_deformer* deformer);
/// P x 3 unit normals, likewise; NULL without normals.
CW_API const double* cw_deformer_normals(const cw_deformer* deformer);
CW_API const double* cw_deformer_cage_positions(const cw_deformer* deformer); ///< C x 3
CW_API size_t
cw_deformer_unbound_count(const cw_deformer* deformer); ///< vertices that stay at rest
CW_API size_t cw_deformer_weight_bytes(const cw_deformer* deformer);

/// Reads a model, its cage, and the cage with its vertices moved, and writes the moved model: the
/// same file with other positions and normals, all else as it was.
/// \param notes  what was taken otherwise than it stands: a JSON array of {"code", "message"}, to
///               be freed with cw_free(); may be NULL
CW_API cw_code cw_deform_file(const char* model, const char* cage, const char* posed,
                              const char* out, const cw_control* control, char** notes,
                              cw_error** error);

typedef struct cw_sequence_options {
  size_t size;              ///< sizeof(cw_sequence_options)
  const char* coordinates;  ///< the kind; NULL: "mean_value"
  const char* settings;     ///< of that kind; NULL: as they are by themselves
  double frames_per_second; ///< of a movement in one file; 0: 24
  double first_frame;       ///< the number of its first frame
} cw_sequence_options;

/// The same for many poses, for which weights are computed once.
/// \param posed      the paths of the cage in each pose; or NULL, and
/// \param positions  the vertices of the cage in each pose: `count` arrays of C x 3
/// \param outs       one path that holds the movement: a point cache (.pc2, .mdd) of any number of
///                   poses, or an animated .glb of several, each a morph target; or a path for each
///                   pose, written as by cw_deform_file()
/// \param options    NULL: mean value coordinates, 24 frames a second from frame 1 on
CW_API cw_code cw_deform_sequence(const char* model, const char* cage, const char* const* posed,
                                  const cw_array* positions, size_t count, const char* const* outs,
                                  size_t out_count, const cw_sequence_options* options,
                                  const cw_control* control, char** notes, cw_error** error);

/* ---- Pictures -------------------------------------------------------------------------------- */

typedef struct cw_render_options {
  size_t size;         ///< sizeof(cw_render_options)
  int width;           ///< of each view, in pixels; 0: 1200
  int height;          ///< 0: 900
  const double* views; ///< pairs of yaw and pitch in degrees; see cw_view_named()
  size_t view_count;   ///< 0: one from three quarters
  int z_up;            ///< else y points up
  int background;      ///< 0: gradient, 1: white, 2: transparent
  int no_shadows;
  int no_ambient_occlusion;
  int model_edges;   ///< draw the sides of the model's polygons
  int no_cage_faces; ///< only lines and dots of the cage
} cw_render_options;

/// front, back, left, right, side, top, bottom or three-quarter: yaw and pitch in degrees.
/// Not 0: there is such a view.
CW_API int cw_view_named(const char* name, double yaw_pitch[2]);

/// A picture: rows from the top, pixels of red, green, blue and opacity from 0 to 255.
typedef struct cw_image cw_image;
CW_API void cw_image_free(cw_image* image);
CW_API size_t cw_image_width(const cw_image* image);
CW_API size_t cw_image_height(const cw_image* image);
CW_API const uint8_t* cw_image_pixels(const cw_image* image); ///< height x width x 4
CW_API cw_code cw_image_write_png(const cw_image* image, const char* path, cw_error** error);

/// Draws a model, and a cage over it, without a display.
/// \param cage     may be NULL
/// \param options  NULL: all 0
CW_API cw_code cw_render(const cw_mesh_view* model, const cw_mesh_view* cage,
                         const cw_render_options* options, cw_image** out, cw_error** error);

/* ---- For C programs -------------------------------------------------------------------------- */

/// Packed xyz doubles as an array.
static inline cw_array cw_points(const double* xyz, size_t count) {
  cw_array array = {xyz, CW_FLOAT64, count, 3, 0, 0};
  return array;
}

/// Packed triangles of 32-bit corners as an array.
static inline cw_array cw_triangles(const uint32_t* corners, size_t count) {
  cw_array array = {corners, CW_UINT32, count, 3, 0, 0};
  return array;
}

/// A mesh of packed positions and triangles.
static inline cw_mesh_view cw_triangle_mesh(const double* xyz, size_t vertices,
                                            const uint32_t* corners, size_t triangles) {
  cw_mesh_view view = {{xyz, CW_FLOAT64, vertices, 3, 0, 0},
                       {corners, CW_UINT32, triangles, 3, 0, 0},
                       {NULL, CW_UINT64, 0, 0, 0, 0}};
  return view;
}

#ifdef __cplusplus
}
#endif

#endif
