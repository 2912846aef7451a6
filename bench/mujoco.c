/* 4,096 simulations of MuJoCo, each with its tool in contact with a soft body of hapsim, on one
 * processor: what the forces of a step of all of them cost of it, as median and 99 % of the
 * steps. The tools begin above the body, fall on it and rest there.
 *   mujoco press.xml body.ply model.csv callback|batch [SIMULATIONS [STEPS]]
 * Between mj_step1() and mj_step2() of all of them, so that it can be timed by itself: `callback`:
 * the function that is mjcb_passive, called for each as mj_step() calls it; `batch`:
 * hapsim_mujoco_batch(). Made and called by mujoco.sh. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "hapsim_mujoco.h"

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int by_size(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static void check(hs_status status) {
  if (status == HS_DONE) return;
  fprintf(stderr, "%s\n", hs_message());
  exit(status);
}

int main(int argc, char** argv) {
  if (argc < 5) return HS_USAGE;
  const int batch = strcmp(argv[4], "batch") == 0;
  const size_t count = argc > 5 ? strtoul(argv[5], NULL, 10) : 4096;
  const size_t steps = argc > 6 ? strtoul(argv[6], NULL, 10) : 400;
  char error[1000] = "";
  mjModel* m = mj_loadXML(argv[1], NULL, error, sizeof error);
  if (!m) {
    fprintf(stderr, "%s\n", error);
    return HS_BAD_INPUT;
  }
  hs_body* body;
  hs_model* model;
  hs_options* options;
  hs_prepared* prepared;
  hapsim_mujoco soft;
  check(hs_body_read(argv[2], &body));
  check(hs_model_read(argv[3], &model));
  check(hs_options_new(&options));
  check(hs_options_set(options, "tool-radius", "4mm"));
  check(hs_options_set(options, "accuracy", "0.05"));
  check(hs_prepare(body, model, NULL, options, &prepared));
  check(hapsim_mujoco_ready(&soft, prepared, m, "tip", count));
  mjData** data = malloc(count * sizeof *data);
  double *tips = malloc(3 * count * sizeof *tips), *forces = malloc(3 * count * sizeof *forces);
  mjfGeneric mjcb_passive = hapsim_mujoco_passive; /* not MuJoCo's own: mj_step1() would call it */
  double *took = malloc(steps * sizeof *took), *forces_took = malloc(steps * sizeof *forces_took);
  for (size_t i = 0; i < count; ++i) { /* spread over the block's top, each at its own place */
    data[i] = mj_makeData(m);
    hapsim_mujoco_own(&soft, i, data[i]);
    data[i]->qpos[0] = 0.012 + 0.096 * fmod(0.754877666 * (double)i, 1);
    data[i]->qpos[1] = 0.012 + 0.066 * fmod(0.569840291 * (double)i, 1);
    data[i]->qpos[2] = 0.0602;
  }
  double all = 0;
  size_t touching = 0, kept = 0;
  for (size_t s = 0; s < steps; ++s) {
    const double begin = now();
    for (size_t i = 0; i < count; ++i) mj_step1(m, data[i]);
    const double middle = now();
    double alone = 0;
    if (batch) {
      hapsim_mujoco_tips(&soft, data, tips);
      const double before = now();
      hs_live_step_all(soft.tools, count, data[0]->time, tips, forces);
      alone = now() - before;
      hapsim_mujoco_apply(&soft, m, data, forces);
    } else {
      for (size_t i = 0; i < count; ++i) mjcb_passive(m, data[i]);
    }
    const double with_mujoco = now() - middle;
    for (size_t i = 0; i < count; ++i) mj_step2(m, data[i]);
    if (s < steps / 4) continue; /* they fall */
    all += now() - begin;
    took[kept] = with_mujoco;
    forces_took[kept++] = alone;
    for (size_t i = 0; i < count && s + 1 == steps; ++i) {
      hs_feel feel;
      hs_live_feel(soft.tools[i], &feel);
      touching += feel.contact != 0 && feel.force[2] > 0;
    }
  }
  qsort(took, kept, sizeof *took, by_size);
  qsort(forces_took, kept, sizeof *forces_took, by_size);
  printf("%s of %s: %zu in contact of %zu: %.2f ms (median), %.2f (99 %%)", argv[4], argv[3],
         touching, count, took[kept / 2], took[kept - 1 - kept / 100]);
  if (batch)
    printf(", hapsim's part %.2f and %.2f", forces_took[kept / 2],
           forces_took[kept - 1 - kept / 100]);
  printf("; MuJoCo's step with it %.2f ms\n", all / (double)kept);
  return touching == count ? 0 : 1;
}
