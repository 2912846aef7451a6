/* c_test FOLDER: the C interface on body.ply, data.csv, motion.csv and model.csv of a folder;
 * writes what the tools write of them: forces.csv, m.csv, residuals.csv, effects.csv, plan.csv,
 * live.csv, press.csv. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hapsim.h"

static int failures = 0;

#define EXPECT(what)                                                  \
  do {                                                                \
    if (!(what)) {                                                    \
      printf("c_test.c:%d: %s: %s\n", __LINE__, #what, hs_message()); \
      ++failures;                                                     \
    }                                                                 \
  } while (0)

static hs_options* options_of(const char* const* words) { /* name, value, ..., null */
  hs_options* options = NULL;
  EXPECT(hs_options_new(&options) == HS_DONE);
  for (; *words != NULL; words += 2) EXPECT(hs_options_set(options, words[0], words[1]) == HS_DONE);
  return options;
}

/* The call fails so, with these words in its message, and leaves nothing. */
#define REFUSED(call, expected, left, words)       \
  do {                                             \
    const hs_status status_ = (call);              \
    refused(status_, (expected), (left), (words)); \
  } while (0)
static void refused(hs_status status, hs_status expected, const void* left, const char* words) {
  if (status == expected && left == NULL && strstr(hs_message(), words) != NULL) return;
  printf("status %d, not %d with '%s': %s\n", (int)status, (int)expected, words, hs_message());
  ++failures;
}

static void test_errors(const hs_body* body, const hs_recording* data) {
  hs_body* no_body = NULL;
  hs_model* no_model = NULL;
  hs_recording* none = NULL;
  hs_identification* nothing = NULL;
  hs_prepared* unready = NULL;
  const char *const unknown[] = {"fold", "3", NULL}, *const bounds[] = {"folds", "2000", NULL},
                    *const fix[] = {"fix", "nu=45", NULL}, *const flag[] = {"profile", "yes", NULL};
  REFUSED(hs_body_read("nowhere.ply", &no_body), HS_IO, no_body, "nowhere.ply");
  REFUSED(hs_model_parse("effect,region,parameter,value\nelastic,0,E,-1\n", "m.csv", &no_model),
          HS_BAD_INPUT, no_model, "m.csv:2");
  REFUSED(hs_model_read("data.csv", &no_model), HS_BAD_INPUT, no_model, "data.csv");
  REFUSED(hs_recording_read("motion.csv", 1, &none), HS_BAD_INPUT, none, "motion.csv");
  const double press[] = {1, 1}, zero[] = {0, 0}, far[] = {0, 25};
  const char* const names[] = {"press", "x", "y", "z", "ux", "uy", "uz"};
  const double* columns[] = {press, zero, zero, zero, zero, zero, far};
  REFUSED(hs_recording_make(names, columns, 7, 2, 0, &none), HS_BAD_INPUT, none, "millimetres");
  struct {
    const char* const* words;
    const char* message;
  } asked[] = {{unknown, "did you mean '--folds'"},
               {bounds, "--folds"},
               {fix, "nu = 45 is out of bounds"},
               {flag, "--profile is 'yes'; give true or false"}};
  for (size_t k = 0; k < sizeof asked / sizeof asked[0]; ++k) {
    hs_options* options = options_of(asked[k].words);
    REFUSED(hs_identify(&body, 1, &data, 1, NULL, options, &nothing), HS_USAGE, nothing,
            asked[k].message);
    hs_options_free(options);
  }
  hs_model* model = NULL;
  EXPECT(hs_model_read("model.csv", &model) == HS_DONE);
  REFUSED(hs_prepare(body, model, NULL, NULL, &unready), HS_USAGE, unready, "--tool-radius");
  REFUSED(hs_model_set(model, "elastic", 0, "nu", 0.7), HS_USAGE, NULL, "out of bounds");
  REFUSED(hs_model_set(model, "elastic", 3, "E", 1), HS_USAGE, NULL, "no elastic.E of region 3");
  hs_model_free(model);
  hs_body_free(NULL);
}

static void test_arrays(const hs_body* body, hs_recording* data) {
  size_t nodes = 0, fixed = 0, tets = 0, faces = 0;
  const double* x = hs_body_nodes(body, &nodes);
  const uint8_t* f = hs_body_fixed(body, &fixed);
  const int32_t* t = hs_body_tetrahedra(body, &tets);
  EXPECT(hs_body_faces(body, &faces) != NULL);
  EXPECT(nodes > 8 && fixed == nodes && tets > 8 && faces > 8);
  for (size_t k = 0; k < 4; ++k) EXPECT(t[k] >= 0 && (size_t)t[k] < nodes);
  double low = 1, held = 0;
  for (size_t k = 0; k < nodes; ++k) {
    if (x[3 * k + 2] < low) low = x[3 * k + 2];
    held += f[k];
  }
  EXPECT(low == 0 && held > 0);

  hs_column u, z, press;
  EXPECT(hs_recording_column(data, "uz", &u) == HS_DONE && u.kind == HS_DOUBLE && u.own);
  EXPECT(hs_recording_column(data, "z", &z) == HS_DONE && z.stride == 3 * sizeof(double));
  EXPECT(hs_recording_column(data, "press", &press) == HS_DONE && press.kind == HS_INT32);
  EXPECT(hs_recording_column(data, "temp", &u) == HS_USAGE && u.data == NULL);
  for (size_t k = 0; k < hs_recording_rows(data); ++k)
    EXPECT(*(const double*)((const char*)z.data + k * z.stride) == 0.04);
  EXPECT(strcmp(hs_recording_column_name(data, 0), "press") == 0);
  EXPECT(strcmp(hs_recording_column_name(data, 10), "fz") == 0 &&
         hs_recording_column_name(data, 11) == NULL);
  EXPECT(strcmp(hs_recording_metadata(data, "tool_radius"), "0.004") == 0);
  EXPECT(hs_recording_metadata(data, "nothing") == NULL);
}

static int told = 0;
static void count(void* context, const char* words) {
  EXPECT(context == &told && *words != 0);
  ++told;
}
static int at_once(void* context) {
  (void)context;
  return 1;
}

/* The tools' commands of c_test.sh. */
static void test_commands(const hs_body* body, hs_recording* data, hs_recording* motion,
                          const hs_model* model) {
  hs_recording *forces = NULL, *plan = NULL;
  EXPECT(hs_simulate(body, model, motion, NULL, &forces) == HS_DONE);
  EXPECT(hs_recording_write(forces, "forces.csv") == HS_DONE);
  hs_recording_free(forces);

  const char* const words[] = {"fix", "nu=0.4", "add", "viscoelastic", "folds", "3", NULL};
  hs_options* options = options_of(words);
  hs_identification* found = NULL;
  const hs_recording* measured = data;
  EXPECT(hs_identify(&body, 1, &measured, 1, NULL, options, &found) == HS_DONE);
  hs_model* fitted = NULL;
  EXPECT(hs_model_copy(hs_identification_model(found), &fitted) == HS_DONE);
  EXPECT(strstr(hs_identification_json(found), "\"hs-identify\"") != NULL);
  hs_identification_free(found);
  EXPECT(hs_model_write(fitted, "m.csv") == HS_DONE && strcmp(hs_model_name(fitted), "m.csv") == 0);
  hs_parameter p;
  EXPECT(hs_model_parameter(fitted, 0, &p) == HS_DONE && p.value > 1000 && p.state == HS_FREE);
  EXPECT(hs_model_parameter(fitted, 99, &p) == HS_USAGE && p.effect == NULL);

  hs_options_listen(options, count, at_once, &told);
  REFUSED(hs_identify(&body, 1, &measured, 1, NULL, options, &found), HS_NO_CONVERGENCE, found,
          "stopped");
  hs_options_free(options);

  hs_comparison* comparison = NULL;
  EXPECT(hs_simulate(body, fitted, data, NULL, &forces) == HS_DONE);
  EXPECT(hs_compare(data, forces, &comparison) == HS_DONE);
  hs_recording* residuals = (hs_recording*)hs_comparison_residuals(comparison);
  hs_column rest;
  EXPECT(hs_recording_column(residuals, "rz", &rest) == HS_DONE && !rest.own);
  EXPECT(hs_recording_write(residuals, "residuals.csv") == HS_DONE);
  EXPECT(strstr(hs_comparison_json(comparison), "\"rmse\"") != NULL);
  hs_comparison_free(comparison);
  hs_recording_free(forces);

  const char* const quick[] = {"flips", "99", "output", "effects.csv", NULL};
  options = options_of(quick);
  hs_diagnosis* diagnosis = NULL;
  EXPECT(hs_diagnose(body, model, data, options, &diagnosis) == HS_DONE);
  EXPECT(hs_diagnosis_write(diagnosis, "effects.csv") == HS_DONE);
  EXPECT(hs_diagnosis_plan(diagnosis, 2, &plan) == HS_DONE);
  EXPECT(hs_recording_write(plan, "plan.csv") == HS_DONE);
  hs_recording_free(plan);
  hs_diagnosis_free(diagnosis);
  hs_options_free(options);
  hs_model_free(fitted);
}

/* Row by row, as hs-simulate --live answers: t,x,y,z of tips, and presses whose contacts are known.
 */
static void test_live(const hs_body* body, const hs_model* model, hs_recording* motion) {
  const char* const words[] = {"tool-radius", "4mm", "accuracy", "0.3", NULL};
  hs_options* options = options_of(words);
  hs_prepared* prepared = NULL;
  EXPECT(hs_prepare(body, model, NULL, options, &prepared) == HS_DONE);
  hs_options_free(options);
  hs_live *live = NULL, *other = NULL;
  EXPECT(hs_live_new(prepared, NULL, &live) == HS_DONE &&
         hs_live_new(prepared, NULL, &other) == HS_DONE);
  hs_live *pair[2] = {NULL, NULL}, *alone[2] = {NULL, NULL};
  for (int k = 0; k < 2; ++k)
    EXPECT(hs_live_new(prepared, NULL, &pair[k]) == HS_DONE &&
           hs_live_new(prepared, NULL, &alone[k]) == HS_DONE);
  EXPECT(hs_prepared_off_contacts(prepared) > 0);
  hs_prepared_free(prepared);

  FILE* out = fopen("live.csv", "w");
  double force[3];
  hs_feel feel;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.001 * i, tip[3] = {0.03, 0.025, 0.0405 - 0.00001 * i};
    hs_live_step(live, t, tip, force);
    hs_live_feel(live, &feel);
    EXPECT(memcmp(force, feel.force, sizeof force) == 0);
    fprintf(out, "%d %d %.17g %.17g %.17g %.17g\n", (int)feel.press, (int)feel.contact, feel.u[2],
            force[0], force[1], force[2]);
  }
  fclose(out);
  EXPECT(feel.contact && feel.force[2] > 0.05);

  out = fopen("press.csv", "w");
  hs_column press, t, x, u;
  EXPECT(hs_recording_column(motion, "press", &press) == HS_DONE &&
         hs_recording_column(motion, "t", &t) == HS_DONE);
  EXPECT(hs_recording_column(motion, "x", &x) == HS_DONE &&
         hs_recording_column(motion, "ux", &u) == HS_DONE);
  for (size_t k = 0; k < hs_recording_rows(motion); ++k) {
    const int32_t* number = press.data;
    const double *at = (const double*)x.data + 3 * k, *by = (const double*)u.data + 3 * k;
    if (k == 0 || number[k] != number[k - 1]) hs_live_begin(other, at);
    hs_live_press(other, ((const double*)t.data)[k], by, 0, force);
    fprintf(out, "%.17g %.17g %.17g\n", force[0], force[1], force[2]);
  }
  fclose(out);

  /* Two at once as each by itself. */
  for (int i = 0; i < 50; ++i) {
    const double tips[6] = {0.03, 0.025, 0.0405 - 5e-5 * i, 0.02, 0.03, 0.041 - 6e-5 * i};
    double together[6], apart[6];
    hs_live_step_all(pair, 2, 0.001 * i, tips, together);
    for (int k = 0; k < 2; ++k) hs_live_step(alone[k], 0.001 * i, tips + 3 * k, apart + 3 * k);
    EXPECT(memcmp(together, apart, sizeof apart) == 0 &&
           (i < 49 || (apart[2] > 0 && apart[5] > 0)));
  }
  for (int k = 0; k < 2; ++k) hs_live_free(pair[k]), hs_live_free(alone[k]);
  hs_live_free(live);
  hs_live_free(other);
}

/* For a hand no force is larger than its limit, however deep it goes, and the end is zero. */
static void test_hand(const hs_body* body, const hs_model* model) {
  const char* const words[] = {"tool-radius", "0.004", "accuracy", "0.3", NULL};
  const char* const limits[] = {"hand", "true", "max-force", "0.1", NULL};
  hs_options *options = options_of(words), *hand = options_of(limits);
  hs_prepared* prepared = NULL;
  hs_live* live = NULL;
  EXPECT(hs_prepare(body, model, NULL, options, &prepared) == HS_DONE);
  EXPECT(hs_live_new(prepared, hand, &live) == HS_DONE);
  double force[3], largest = 0;
  hs_feel feel;
  for (int i = 0; i < 500; ++i) {
    const double tip[3] = {0.03, 0.025, 0.0405 - 0.00001 * i};
    hs_live_step(live, 0.001 * i, tip, force);
    if (force[2] > largest) largest = force[2];
  }
  hs_live_feel(live, &feel);
  EXPECT(largest > 0.09 && largest <= 0.1000001 && feel.safety != 0 && feel.asked[2] > 0.1);
  hs_live_miss(live, 10, force);
  EXPECT(force[2] < largest);
  hs_live_end(live);
  hs_live_feel(live, &feel);
  EXPECT(feel.force[2] == 0);
  hs_live_free(live);
  hs_prepared_free(prepared);
  hs_options_free(options);
  hs_options_free(hand);
}

int main(void) {
  hs_body* body = NULL;
  hs_recording *data = NULL, *motion = NULL;
  hs_model* model = NULL;
  EXPECT(hs_interface() == HS_INTERFACE && strlen(hs_version()) > 4);
  EXPECT(hs_body_read("body.ply", &body) == HS_DONE);
  EXPECT(hs_recording_read("data.csv", 1, &data) == HS_DONE);
  EXPECT(hs_recording_read("motion.csv", 0, &motion) == HS_DONE);
  EXPECT(hs_model_read("model.csv", &model) == HS_DONE);
  if (failures > 0) return 1;
  test_errors(body, data);
  test_arrays(body, data);
  test_commands(body, data, motion, model);
  test_live(body, model, motion);
  test_hand(body, model);
  hs_model_free(model);
  hs_recording_free(motion);
  hs_recording_free(data);
  hs_body_free(body);
  printf("%d failures\n", failures);
  return failures > 0;
}
