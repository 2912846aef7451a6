/* hapsim for programs in any language: bodies, recordings and models as files of hapsim have them,
 * and what the tools of the same names do with them. Link with -lhapsim.
 *
 * Handles are opaque; who gets one frees it, and freeing a null is nothing. What a handle is made
 * of may be freed before it. Text and numbers that a function points to belong to its handle, and
 * live until that is freed or changed. Text is UTF-8. Numbers are in SI units and in the frame of
 * the body.
 *
 * Nothing is thrown: what can fail returns a status, which is the exit code of the tool that would
 * fail so, and hs_message() says what is wrong and what to do in that tool's words. An output is
 * set when the status is HS_DONE, and null otherwise. Handles may be used by several threads at
 * once as long as none of them changes or frees one. Functions are added with a new HS_INTERFACE;
 * none changes or goes while the library is named libhapsim.so.0. */
#ifndef HAPSIM_H
#define HAPSIM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HS_API __attribute__((visibility("default")))
#define HS_INTERFACE 2

typedef enum hs_status {
  HS_DONE = 0,
  HS_USAGE = 2,          /* an option is wrong, or names what is not there */
  HS_BAD_INPUT = 3,      /* a file or an array holds what cannot be used, or lacks what is needed */
  HS_NO_CONVERGENCE = 4, /* a numerical method failed or did not converge, or was stopped */
  HS_IO = 5              /* reading or writing failed, or there is no memory */
} hs_status;

HS_API const char* hs_version(void); /* of hapsim: "0.1.0" */
HS_API int hs_interface(void);       /* the HS_INTERFACE that the library has */
/* Of the last call of this thread that did not return HS_DONE: "where: what is wrong; what to do".
 */
HS_API const char* hs_message(void);

typedef struct hs_options hs_options;
typedef struct hs_body hs_body;
typedef struct hs_recording hs_recording;
typedef struct hs_model hs_model;
typedef struct hs_identification hs_identification;
typedef struct hs_comparison hs_comparison;
typedef struct hs_diagnosis hs_diagnosis;
typedef struct hs_prepared hs_prepared;
typedef struct hs_live hs_live;

/* ---- Options: the flags of the tools without their dashes, and values as on a command line: "fix"
 * and "nu=0.45", "add-noise" and "10mN", of a flag without a value "true" or "false". What may be
 * given several times may be set several times. Wherever options are taken a null is none. */
HS_API hs_status hs_options_new(hs_options** options);
HS_API void hs_options_free(hs_options* options);
HS_API hs_status hs_options_set(hs_options* options, const char* name, const char* value);
/* What happens meanwhile, in the calling thread: `say` gets the sentences of a tool's standard
 * error, `stop` is asked now and then and ends the work where it is not 0. Either may be null;
 * neither may throw. */
HS_API void hs_options_listen(hs_options* options, void (*say)(void* context, const char* words),
                              int (*stop)(void* context), void* context);

/* ---- Bodies: tetrahedra of any format that the tools read. */
HS_API hs_status hs_body_read(const char* path, hs_body** body);
HS_API void hs_body_free(hs_body* body);
HS_API const char* hs_body_name(const hs_body* body);
/* count x 3 [m]; count flags, 1: bonded to the support; count x 10 indices of nodes, of first order
 * -1 from the fifth on; a region each; boundary triangles, count x 3, outward. */
HS_API const double* hs_body_nodes(const hs_body* body, size_t* count);
HS_API const uint8_t* hs_body_fixed(const hs_body* body, size_t* count);
HS_API const int32_t* hs_body_tetrahedra(const hs_body* body, size_t* count);
HS_API const int32_t* hs_body_regions(const hs_body* body, size_t* count);
HS_API const int32_t* hs_body_faces(const hs_body* body, size_t* count);

/* ---- Recordings of presses, measured or simulated, and motions, which have no forces. */
HS_API hs_status hs_recording_read(const char* path, int need_forces, hs_recording** recording);
/* From columns by name (press, t, x, y, z, ux, uy, uz, fx, ...), one number a row; checked as a
 * file is. */
HS_API hs_status hs_recording_make(const char* const* names, const double* const* columns,
                                   size_t count, size_t rows, int need_forces,
                                   hs_recording** recording);
HS_API hs_status hs_recording_write(hs_recording* recording,
                                    const char* path); /* as hs_model_write() */
HS_API void hs_recording_free(hs_recording* recording);
HS_API const char* hs_recording_name(const hs_recording* recording);
HS_API size_t hs_recording_rows(const hs_recording* recording);

typedef enum hs_kind { HS_DOUBLE = 0, HS_INT32 = 1, HS_INT8 = 2 } hs_kind;
typedef struct hs_column {
  void* data;    /* of the first row */
  size_t stride; /* bytes from one row to the next */
  hs_kind kind;
  int32_t
      own; /* it may be written to; 0: of a column that hapsim does not know, read from its text */
} hs_column;
/* press (HS_INT32), contact (HS_INT8), t, x, y, z, ux, uy, uz, fx, fy, fz, temp. x, y, z of a row
 * stand beside each other, so do the displacements and the forces. Others are HS_DOUBLE. HS_USAGE:
 * it has no such column. */
HS_API hs_status hs_recording_column(hs_recording* recording, const char* name, hs_column* column);
/* The names of the columns, in the order of the file; null past the last. */
HS_API const char* hs_recording_column_name(const hs_recording* recording, size_t number);
/* `# key: value` of its file; null where there is none. A null value removes it. */
HS_API const char* hs_recording_metadata(const hs_recording* recording, const char* key);
HS_API const char* hs_recording_metadata_key(const hs_recording* recording, size_t number);
HS_API hs_status hs_recording_set_metadata(hs_recording* recording, const char* key,
                                           const char* value);

/* ---- Models: model.csv. */
HS_API hs_status hs_model_read(const char* path, hs_model** model);
HS_API hs_status hs_model_parse(const char* text, const char* name, hs_model** model);
HS_API hs_status hs_model_write(hs_model* model, const char* path); /* it is named so from now on */
HS_API hs_status hs_model_copy(const hs_model* model, hs_model** copy);
HS_API void hs_model_free(hs_model* model);
HS_API const char* hs_model_name(const hs_model* model);
HS_API const char* hs_model_text(hs_model* model); /* the file's */
typedef enum hs_state { HS_FREE = 0, HS_FIXED = 1, HS_DERIVED = 2 } hs_state;
typedef struct hs_parameter {
  const char* effect;
  int region;
  const char* parameter;
  double value;
  const char* unit;
  double std_error; /* NaN: not estimated */
  double lower, upper;
  hs_state state;
} hs_parameter;
HS_API size_t hs_model_parameters(const hs_model* model);
HS_API hs_status hs_model_parameter(const hs_model* model, size_t number, hs_parameter* parameter);
/* HS_USAGE: there is none, or the value is beyond its bounds. */
HS_API hs_status hs_model_set(hs_model* model, const char* effect, int region,
                              const char* parameter, double value);
HS_API const char* hs_model_metadata(const hs_model* model, const char* key);
HS_API const char* hs_model_metadata_key(const hs_model* model, size_t number);

/* ---- hs-simulate: the motion with the model's forces. Options: tool-radius, rim-edge, threads,
 * cache, add-noise, seed. */
HS_API hs_status hs_simulate(const hs_body* body, const hs_model* model, const hs_recording* motion,
                             const hs_options* options, hs_recording** forces);

/* ---- hs-identify: of one body, or one for each recording. `start` may be null. Options: those of
 * hs_simulate but noise's and seed's, and noise, floor, effects, add, remove, fix, free, terms,
 * windows, regions, folds, robust, profile, starts, seed. */
HS_API hs_status hs_identify(const hs_body* const* bodies, size_t body_count,
                             const hs_recording* const* recordings, size_t recording_count,
                             const hs_model* start, const hs_options* options,
                             hs_identification** identification);
HS_API void hs_identification_free(hs_identification* identification);
HS_API const hs_model* hs_identification_model(const hs_identification* identification);
/* What is said at the end, as by --json (summary.schema.json). */
HS_API const char* hs_identification_json(const hs_identification* identification);

/* ---- hs-compare. */
HS_API hs_status hs_compare(const hs_recording* measured, const hs_recording* simulated,
                            hs_comparison** comparison);
HS_API void hs_comparison_free(hs_comparison* comparison);
HS_API const char* hs_comparison_json(const hs_comparison* comparison); /* as by --json */
HS_API const hs_recording* hs_comparison_residuals(const hs_comparison* comparison);

/* ---- hs-diagnose. Options: tool-radius, noise, floor, rim-edge, threads, cache, folds, flips,
 * seed; output: where the table will lie, for the commands that it tells. */
HS_API hs_status hs_diagnose(const hs_body* body, const hs_model* model,
                             const hs_recording* recording, const hs_options* options,
                             hs_diagnosis** diagnosis);
HS_API void hs_diagnosis_free(hs_diagnosis* diagnosis);
HS_API const char* hs_diagnosis_json(const hs_diagnosis* diagnosis); /* as by --json */
HS_API const char* hs_diagnosis_text(const hs_diagnosis* diagnosis); /* the table */
HS_API hs_status hs_diagnosis_write(const hs_diagnosis* diagnosis, const char* path);
/* --plan: the motion of the next `presses` presses to record. */
HS_API hs_status hs_diagnosis_plan(const hs_diagnosis* diagnosis, size_t presses,
                                   hs_recording** motion);

/* ---- hs-simulate --live. A body and a model made ready; never changed after, so that any number
 * of loops and threads may share one. `contacts` may be null: a recording whose contact positions
 * are solved finely. Options: tool-radius, accuracy, rim-edge, threads, cache; recovery: full where
 * the body recovers between presses. */
HS_API hs_status hs_prepare(const hs_body* body, const hs_model* model,
                            const hs_recording* contacts, const hs_options* options,
                            hs_prepared** prepared);
HS_API void hs_prepared_free(hs_prepared* prepared);
HS_API double hs_prepared_off_contacts(const hs_prepared* prepared); /* metadata off_contacts */

typedef struct hs_feel {
  int32_t press;      /* of hs_live_step(): touches, counted from 1; 0 before the first */
  int32_t contact;    /* 0: off the body */
  int32_t beyond;     /* of what the force is beyond: hs-simulate(1) */
  int32_t safety;     /* for a hand: why it is not what was asked for, hs-safety(7) */
  double point[3];    /* contact point on the undeformed surface [m] */
  double u[3];        /* displacement that the force is of [m] */
  double force[3];    /* of the body on the tool [N] */
  double uncertainty; /* standard, of its length, that the place leaves [N] */
  double asked[3];    /* for a hand: the force that was asked for [N] */
} hs_feel;

/* A tool of one thread. Options: of a hand, the limits of hs-safety(7): hand, device, max-force,
 * max-rate, max-power, max-speed, max-energy, any-energy, hold, ramp. */
HS_API hs_status hs_live_new(const hs_prepared* prepared, const hs_options* options,
                             hs_live** live);
HS_API void hs_live_free(hs_live* live);
/* At time t [s] the tip is at `tip`, anywhere: the force of the body on it [N]. No allocation, no
 * lock, no system call. A tip that is not finite, or beyond 10 m, repeats the last; time that runs
 * backwards counts as none. */
HS_API void hs_live_step(hs_live* live, double t, const double tip[3], double force[3]);
/* The same of many tools, one after the other: tips and forces are count x 3. Since HS_INTERFACE 2.
 */
HS_API void hs_live_step_all(hs_live* const* lives, size_t count, double t, const double* tips,
                             double* forces);
/* A recorded motion instead, whose contact point is known: at each new press, then its
 * displacements. */
HS_API void hs_live_begin(hs_live* live, const double contact[3]);
HS_API void hs_live_press(hs_live* live, double t, const double u[3], int in_air, double force[3]);
/* Of the last step. */
HS_API void hs_live_feel(const hs_live* live, hs_feel* feel);
/* Of the body from the next step on [degC]; NaN: not known. */
HS_API void hs_live_set_temperature(hs_live* live, double temperature);
/* For a hand: nothing has come; and zero, at once and for ever. */
HS_API void hs_live_miss(hs_live* live, double t, double force[3]);
HS_API void hs_live_end(hs_live* live);

#ifdef __cplusplus
}
#endif

#endif
