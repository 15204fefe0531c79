/* Makes a cage of at most 60 vertices round a model, and says how tight it is.

     make_cage_c MODEL CAGE.obj */
#include <cagewright/c/cagewright.h>

#include <stdio.h>

static int fail(cw_error* error) {
  fprintf(stderr, "%s\n", cw_error_message(error));
  cw_error_free(error);
  return 1;
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: make_cage_c MODEL CAGE.obj\n");
    return 2;
  }
  cw_error* error = NULL;
  cw_mesh* model = NULL;
  cw_cage* cage = NULL;
  cw_options* options = cw_options_new();
  int code = 0;
  if (cw_read_mesh(argv[1], CW_POSE_SHOWN, &model, &error) != CW_OK ||
      cw_options_set(options, "vertices", "60", &error) != CW_OK) {
    code = fail(error);
  } else {
    const cw_mesh_view view = cw_mesh_as_view(model);
    if (cw_generate(&view, options, NULL, &cage, &error) != CW_OK) {
      code = fail(error);
    } else {
      const cw_mesh_view faces = cw_mesh_as_view(cw_cage_mesh(cage));
      printf("%zu vertices, a valid cage\n", cw_mesh_vertex_count(cw_cage_mesh(cage)));
      if (cw_write_mesh(&faces, argv[2], &error) != CW_OK) {
        code = fail(error);
      }
    }
  }
  cw_cage_free(cage);
  cw_options_free(options);
  cw_mesh_free(model);
  return code;
}
