/* MuJoCo (2.2.2, as in Debian 12) with the contact forces of hapsim: soft bodies as they were
 * identified, pressed by sites of a MuJoCo model. Link with -lmujoco -lhapsim.
 *
 *   hapsim_mujoco_ready(&soft, prepared, model, "tip", 1);       one simulation,
 *   hapsim_mujoco_ready(&soft, prepared, model, "tip", 4096);    or as many side by side
 *   mjcb_passive = hapsim_mujoco_passive;
 *   hapsim_mujoco_own(&soft, number, data);                      this mjData is that one
 *
 * and mj_step() as ever; after mj_resetData(), which forgets whose an mjData is, own() again: until
 * then it feels nothing. The site's position in the soft body's frame is the tool's tip; the force
 * acts there on the site's body. The model needs <size nuserdata="1"/>, in which an mjData keeps
 * its number; the frame of the body is that of the world, moved by `origin`. Use the integrators
 * Euler or implicit: RK4 asks for passive forces at times that do not come, and a body that
 * remembers would remember them. Take the geoms of soft bodies out of MuJoCo's own contacts. */
#ifndef HAPSIM_MUJOCO_H
#define HAPSIM_MUJOCO_H

#include <hapsim.h>
#include <mujoco/mujoco.h>
#include <stdlib.h>

typedef struct hapsim_mujoco {
  hs_live** tools; /* one a simulation */
  size_t count;
  int site, body;   /* of the MuJoCo model */
  double origin[3]; /* of the soft body's frame in the world [m] */
} hapsim_mujoco;

/* What the callback answers for; MuJoCo's callbacks are global and have no argument of their own.
 */
static hapsim_mujoco* hapsim_mujoco_now = NULL;

static inline void hapsim_mujoco_free(hapsim_mujoco* soft) {
  for (size_t i = 0; i < soft->count; ++i) hs_live_free(soft->tools[i]);
  free(soft->tools);
  soft->tools = NULL;
  soft->count = 0;
  if (hapsim_mujoco_now == soft) hapsim_mujoco_now = NULL;
}

/* HS_USAGE: the model has no such site, or no userdata. Otherwise as hs_live_new(). */
static inline hs_status hapsim_mujoco_ready(hapsim_mujoco* soft, const hs_prepared* prepared,
                                            const mjModel* model, const char* site, size_t count) {
  soft->count = 0;
  soft->tools = NULL;
  soft->site = mj_name2id(model, mjOBJ_SITE, site);
  for (int k = 0; k < 3; ++k) soft->origin[k] = 0;
  if (soft->site < 0 || model->nuserdata < 1) return HS_USAGE;
  soft->body = model->site_bodyid[soft->site];
  soft->tools = (hs_live**)calloc(count, sizeof *soft->tools);
  if (!soft->tools) return HS_IO;
  for (; soft->count < count; ++soft->count) {
    const hs_status status = hs_live_new(prepared, NULL, &soft->tools[soft->count]);
    if (status == HS_DONE) continue;
    hapsim_mujoco_free(soft);
    return status;
  }
  hapsim_mujoco_now = soft;
  return HS_DONE;
}

/* Kept as the number and one, so that what MuJoCo has zeroed is nobody's. */
static inline void hapsim_mujoco_own(const hapsim_mujoco* soft, size_t number, mjData* data) {
  data->userdata[0] = (mjtNum)(number < soft->count ? number + 1 : 0);
}

/* Adds a force at the site to `qfrc`. */
static inline void hapsim_mujoco_push(const hapsim_mujoco* soft, const mjModel* m, mjData* d,
                                      const double force[3], mjtNum* qfrc) {
  static const mjtNum none[3] = {0, 0, 0};
  if (force[0] != 0 || force[1] != 0 || force[2] != 0)
    mj_applyFT(m, d, force, none, d->site_xpos + 3 * soft->site, soft->body, qfrc);
}

/* One step of the tool of this mjData, its force among the passive ones; nothing for an mjData that
 * is not owned. */
static inline void hapsim_mujoco_press(const hapsim_mujoco* soft, const mjModel* m, mjData* d) {
  const size_t owned = d->userdata[0] > 0 ? (size_t)d->userdata[0] : 0;
  if (owned < 1 || owned > soft->count) return;
  const mjtNum* at = d->site_xpos + 3 * soft->site;
  const double tip[3] = {at[0] - soft->origin[0], at[1] - soft->origin[1], at[2] - soft->origin[2]};
  double force[3];
  hs_live_step(soft->tools[owned - 1], d->time, tip, force);
  hapsim_mujoco_push(soft, m, d, force, d->qfrc_passive);
}

/* mjcb_passive of one bridge; several are pressed in a callback of your own. */
static inline void hapsim_mujoco_passive(const mjModel* m, mjData* d) {
  if (hapsim_mujoco_now) hapsim_mujoco_press(hapsim_mujoco_now, m, d);
}

/* All simulations at once, instead of the callback: between mj_step1() and mj_step2() of each, at
 * the same time in all. `tips` and `forces` have room for 3 numbers a simulation. The force stands
 * in qfrc_applied, in the place of what was there: add your own after it. */
static inline void hapsim_mujoco_tips(const hapsim_mujoco* soft, mjData* const* data,
                                      double* tips) {
  for (size_t i = 0; i < soft->count; ++i)
    for (int k = 0; k < 3; ++k)
      tips[3 * i + k] = data[i]->site_xpos[3 * soft->site + k] - soft->origin[k];
}

static inline void hapsim_mujoco_apply(const hapsim_mujoco* soft, const mjModel* m,
                                       mjData* const* data, const double* forces) {
  for (size_t i = 0; i < soft->count; ++i) {
    mju_zero(data[i]->qfrc_applied, m->nv);
    hapsim_mujoco_push(soft, m, data[i], forces + 3 * i, data[i]->qfrc_applied);
  }
}

static inline void hapsim_mujoco_batch(const hapsim_mujoco* soft, const mjModel* m,
                                       mjData* const* data, double* tips, double* forces) {
  hapsim_mujoco_tips(soft, data, tips);
  hs_live_step_all(soft->tools, soft->count, data[0]->time, tips, forces);
  hapsim_mujoco_apply(soft, m, data, forces);
}

#endif
