/* From a model in a file to the posed model in a file: makes a cage of at most so many vertices, writes
   it, and moves the model as a posed copy of that cage says.

     from_file_to_pose_c MODEL VERTICES CAGE.obj POSED_CAGE OUT */
#include <cagewright/c/cagewright.h>

#include <stdio.h>

static int fail(cw_error* error) {
  fprintf(stderr, "%s\n", cw_error_message(error));
  cw_error_free(error);
  return 2;
}

int main(int argc, char** argv) {
  if (argc != 6) {
    fprintf(stderr, "usage: from_file_to_pose_c MODEL VERTICES CAGE.obj POSED_CAGE OUT\n");
    return 2;
  }
  cw_error* error = NULL;
  cw_mesh* model = NULL;
  cw_cage* cage = NULL;
  cw_options* options = cw_options_new();
  int code = 0;
  if (cw_read_mesh(argv[1], CW_POSE_SHOWN, &model, &error) != CW_OK ||
      cw_options_set(options, "vertices", argv[2], &error) != CW_OK) {
    code = fail(error);
  } else {
    const cw_mesh_view view = cw_mesh_as_view(model);
    if (cw_generate(&view, options, NULL, &cage, &error) != CW_OK) {
      code = fail(error);
    } else {
      const cw_mesh_view faces = cw_mesh_as_view(cw_cage_mesh(cage));
      if (cw_write_mesh(&faces, argv[3], &error) != CW_OK ||
          cw_deform_file(argv[1], argv[3], argv[4], argv[5], NULL, NULL, &error) != CW_OK) {
        code = fail(error);
      }
    }
  }
  cw_cage_free(cage);
  cw_options_free(options);
  cw_mesh_free(model);
  return code;
}
