/* A tool of 20 g in MuJoCo comes to rest on a body that hapsim has identified.
 * usage: press X Y Z press.xml body.ply m.csv RADIUS
 *   X Y Z [m]: where the tool begins, in the body's frame; RADIUS of the tool: 0.004 or 4mm. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "hapsim_mujoco.h"

int main(int argc, char** argv) {
  if (argc != 8) {
    fprintf(stderr, "usage: %s X Y Z press.xml body.ply m.csv RADIUS\n", argv[0]);
    return HS_USAGE;
  }
  double begin[3];
  for (int k = 0; k < 3; ++k) {
    char* end = argv[1 + k];
    begin[k] = strtod(argv[1 + k], &end);
    if (end == argv[1 + k] || *end != 0) {
      fprintf(stderr, "%s: not a number of metres\n", argv[1 + k]);
      return HS_USAGE;
    }
  }
  char error[1000] = "";
  mjModel* m = mj_loadXML(argv[4], NULL, error, sizeof error);
  if (!m) {
    fprintf(stderr, "%s: %s\n", argv[4], error);
    return HS_BAD_INPUT;
  }
  if (mj_name2id(m, mjOBJ_SITE, "tip") < 0 || m->nuserdata < 1 || m->nq < 3) {
    fprintf(stderr, "%s: no site \"tip\", no <size nuserdata=\"1\"/>, or no three joints\n",
            argv[4]);
    mj_deleteModel(m);
    return HS_BAD_INPUT;
  }
  mjData* d = mj_makeData(m);
  hs_body* body = NULL;
  hs_model* model = NULL;
  hs_options* options = NULL;
  hs_prepared* prepared = NULL;
  hapsim_mujoco soft = {0};
  hs_status status = hs_body_read(argv[5], &body);
  if (status == HS_DONE) status = hs_model_read(argv[6], &model);
  if (status == HS_DONE) status = hs_options_new(&options);
  if (status == HS_DONE) status = hs_options_set(options, "tool-radius", argv[7]);
  if (status == HS_DONE)
    status = hs_prepare(body, model, NULL, options, &prepared); /* some 20 s the first time */
  if (status == HS_DONE) status = hapsim_mujoco_ready(&soft, prepared, m, "tip", 1);
  if (status == HS_DONE) {
    mjcb_passive = hapsim_mujoco_passive;
    hapsim_mujoco_own(&soft, 0, d);
    for (int k = 0; k < 3; ++k) d->qpos[k] = begin[k];
    for (int i = 0; i < 4000; ++i) mj_step(m, d);
    mj_forward(m, d);
    hs_feel feel;
    hs_live_feel(soft.tools[0], &feel);
    const double weight = -m->opt.gravity[2] * mj_getTotalmass(m);
    printf("weight %.6f N, the body bears %.6f N, %.4f mm deep, speed %.1e m/s\n", weight,
           feel.force[2], -1000 * feel.u[2], fabs(d->qvel[2]));
  } else {
    fprintf(stderr, "%s\n", hs_message());
  }
  mjcb_passive = NULL;
  hapsim_mujoco_free(&soft);
  hs_prepared_free(prepared);
  hs_options_free(options);
  hs_model_free(model);
  hs_body_free(body);
  mj_deleteData(d);
  mj_deleteModel(m);
  return status;
}
