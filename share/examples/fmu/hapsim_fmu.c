/* A body and a model of hapsim as an FMU of FMI 2.0 for co-simulation: where the tip is in, the
 * force on it out, as hs-simulate --live has it, over the C interface of libhapsim.so. Built and
 * packed by make-fmu.sh, which gives HAPSIM_FMU_GUID, HAPSIM_FMU_RADIUS and HAPSIM_FMU_ACCURACY.
 *
 * A step from t to t + h is one step of the live loop: at t + h the tip is where the inputs are,
 * and the motion to there is straight. On leaving the initialisation the tip is at the inputs'
 * start. Body and model are made ready then, which takes some seconds the first time, and are kept
 * by content in the user's cache. */
#include <ctype.h>
#include <hapsim.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2_declarations.h"

/* The value references of modelDescription.xml. */
enum { kX, kY, kZ, kFx, kFy, kFz, kUncertainty, kToolRadius, kAccuracy, kReals };
enum { kBeyond, kPress, kIntegers };
enum { kContact, kBooleans };
enum { kDirectory, kStrings };

/* Where an instance stands; a function names those in which it may be called. */
enum { kInstantiated = 1, kInitialising = 2, kStepping = 4, kTerminated = 8, kAny = 15 };

/* As hs-simulate: beyond it the unit is wrong [m]. */
static const double kLargestPosition = 10;

typedef struct {
  const fmi2CallbackFunctions* callbacks;
  char *name, *resources, *directory; /* directory: the parameter; empty: the resources */
  const char* lack;                   /* why there are no resources */
  int state, logging, set_up;
  double real[kReals], start, stop, time;
  int stop_defined, dirty; /* dirty: the outputs are not those of the inputs */
  int integer[kIntegers], boolean[kBooleans];
  hs_prepared* prepared;
  hs_live* live;
} Instance;

static char* copied(const char* text) {
  const size_t length = strlen(text) + 1;
  char* copy = malloc(length);
  if (copy) memcpy(copy, text, length);
  return copy;
}

static void tell(const Instance* c, fmi2Status status, const char* category, const char* words) {
  if (c->callbacks->logger && (c->logging || status >= fmi2Warning))
    c->callbacks->logger(c->callbacks->componentEnvironment, c->name, status, category, "%s",
                         words);
}

static fmi2Status failed(const Instance* c, const char* where, const char* words) {
  char text[2000];
  snprintf(text, sizeof text, "%s: %s", where, words);
  tell(c, fmi2Error, "logStatusError", text);
  return fmi2Error;
}

static fmi2Status of_library(const Instance* c, const char* where) {
  return failed(c, where, hs_message());
}

static int may(const Instance* c, int states, const char* where) {
  if (!c) return 0;
  if (c->state & states) return 1;
  failed(
      c, where,
      c->state == kInstantiated ? "not before fmi2EnterInitializationMode; or fmi2Reset came before"
      : c->state == kInitialising ? "not before fmi2ExitInitializationMode"
      : c->state == kStepping ? "not while steps are made; fmi2Terminate, then fmi2Reset come first"
                              : "not after fmi2Terminate; fmi2Reset comes first");
  return 0;
}

static void forget(Instance* c) {
  hs_live_free(c->live);
  hs_prepared_free(c->prepared);
  c->live = NULL;
  c->prepared = NULL;
  c->dirty = 1;
}

static void start_values(Instance* c) {
  memset(c->real, 0, sizeof c->real);
  memset(c->integer, 0, sizeof c->integer);
  memset(c->boolean, 0, sizeof c->boolean);
  c->real[kZ] = 1; /* in the air */
  c->real[kToolRadius] = HAPSIM_FMU_RADIUS;
  c->real[kAccuracy] = HAPSIM_FMU_ACCURACY;
  c->start = c->time = c->stop = 0;
  c->stop_defined = c->set_up = 0;
  c->directory[0] = 0;
}

/* A folder of "file:///a%20b" or "file:/a%20b"; null: it is no URI of a file of this machine, or
 * %00 would end it early. A % that begins no escape is itself. */
static char* path_of(const char* uri) {
  static const char* const kBefore[] = {"file://localhost/", "file:///", "file:/"};
  for (size_t i = 0; i < sizeof kBefore / sizeof *kBefore; ++i) {
    const size_t length = strlen(kBefore[i]);
    if (strncmp(uri, kBefore[i], length) != 0) continue;
    if (i == 2 && uri[length] == '/') return NULL; /* file://host/ */
    char* path = copied(uri + length - 1);         /* its slash stays */
    if (!path) return NULL;
    char* to = path;
    for (const char* from = path; *from; ++from) {
      if (*from == '%' && isxdigit((unsigned char)from[1]) && isxdigit((unsigned char)from[2])) {
        const char digits[] = {from[1], from[2], 0};
        *to = (char)strtoul(digits, NULL, 16);
        if (!*to++) return free(path), NULL;
        from += 2;
      } else {
        *to++ = *from;
      }
    }
    *to = 0;
    return path;
  }
  return NULL;
}

static void said(void* context, const char* words) {
  tell(context, fmi2OK, "logAll", words);
}

/* Reads body.ply, model.csv and, where there is one, contacts.csv of a folder, and makes them
 * ready. */
static fmi2Status prepare(Instance* c, const char* where) {
  const char* folder = c->directory[0] ? c->directory : c->resources;
  if (!folder) return failed(c, where, c->lack);
  const size_t length = strlen(folder) + 16;
  char* path = malloc(length);
  if (!path) return failed(c, where, "no memory");
  hs_body* body = NULL;
  hs_model* model = NULL;
  hs_recording* contacts = NULL;
  hs_options* options = NULL;
  char number[40];
  hs_status status = hs_options_new(&options);
  if (status == HS_DONE) {
    hs_options_listen(options, said, NULL, c);
    snprintf(number, sizeof number, "%.17g", c->real[kToolRadius]);
    status = hs_options_set(options, "tool-radius", number);
  }
  if (status == HS_DONE) {
    snprintf(number, sizeof number, "%.17g", c->real[kAccuracy]);
    status = hs_options_set(options, "accuracy", number);
  }
  snprintf(path, length, "%s/body.ply", folder);
  if (status == HS_DONE) status = hs_body_read(path, &body);
  snprintf(path, length, "%s/model.csv", folder);
  if (status == HS_DONE) status = hs_model_read(path, &model);
  snprintf(path, length, "%s/contacts.csv", folder);
  FILE* there = fopen(path, "r");
  if (there) fclose(there);
  if (status == HS_DONE && there) status = hs_recording_read(path, 0, &contacts);
  if (status == HS_DONE) status = hs_prepare(body, model, contacts, options, &c->prepared);
  const fmi2Status result = status == HS_DONE ? fmi2OK : of_library(c, where);
  hs_options_free(options);
  hs_recording_free(contacts);
  hs_model_free(model);
  hs_body_free(body);
  free(path);
  return result;
}

static void step_to(Instance* c, double t) {
  hs_live_step(c->live, t, c->real + kX, c->real + kFx);
  hs_feel feel;
  hs_live_feel(c->live, &feel);
  c->real[kUncertainty] = feel.uncertainty;
  c->integer[kBeyond] = feel.beyond;
  c->integer[kPress] = feel.press;
  c->boolean[kContact] = feel.contact != 0;
  c->time = t;
  c->dirty = 0;
}

/* The outputs at the start, of a body that nobody has touched. */
static fmi2Status begin(Instance* c, const char* where) {
  if (!c->prepared) {
    const fmi2Status status = prepare(c, where);
    if (status != fmi2OK) return status;
  }
  hs_live_free(c->live);
  c->live = NULL;
  if (hs_live_new(c->prepared, NULL, &c->live) != HS_DONE) return of_library(c, where);
  step_to(c, c->start);
  return fmi2OK;
}

const char* fmi2GetTypesPlatform(void) {
  return fmi2TypesPlatform;
}
const char* fmi2GetVersion(void) {
  return fmi2Version;
}

fmi2Component fmi2Instantiate(fmi2String instance, fmi2Type type, fmi2String guid,
                              fmi2String resources, const fmi2CallbackFunctions* callbacks,
                              fmi2Boolean visible, fmi2Boolean logging) {
  (void)visible;
  if (!callbacks || !instance || !instance[0] || !guid) return NULL;
  Instance* c = calloc(1, sizeof *c);
  if (!c) return NULL;
  c->callbacks = callbacks;
  c->logging = logging;
  c->name = copied(instance);
  c->directory = copied("");
  c->resources = resources ? path_of(resources) : NULL;
  c->lack =
      resources
          ? "the folder of resources that fmi2Instantiate was given is no file:///FOLDER of this "
            "machine; give it so, or set the parameter model_directory"
          : "fmi2Instantiate was given no folder of resources; set the parameter model_directory";
  c->state = kInstantiated;
  int good = c->name && c->directory;
  if (good && type != fmi2CoSimulation) {
    failed(c, "fmi2Instantiate", "this FMU is for co-simulation");
    good = 0;
  } else if (good && strcmp(guid, HAPSIM_FMU_GUID) != 0) {
    failed(c, "fmi2Instantiate",
           "modelDescription.xml is that of another FMU (guid); pack it again");
    good = 0;
  } else if (good && HS_INTERFACE > hs_interface()) {
    failed(c, "fmi2Instantiate",
           "libhapsim.so is older than this FMU; install that of its version");
    good = 0;
  }
  if (!good) {
    fmi2FreeInstance(c);
    return NULL;
  }
  start_values(c);
  c->dirty = 1;
  return c;
}

void fmi2FreeInstance(fmi2Component component) {
  Instance* c = component;
  if (!c) return;
  forget(c);
  free(c->name);
  free(c->resources);
  free(c->directory);
  free(c);
}

fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean logging, size_t count,
                               const fmi2String categories[]) {
  Instance* c = component;
  (void)count;
  (void)categories;
  if (!may(c, kAny, "fmi2SetDebugLogging")) return fmi2Error;
  c->logging = logging;
  return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean tolerance_defined,
                               fmi2Real tolerance, fmi2Real start, fmi2Boolean stop_defined,
                               fmi2Real stop) {
  Instance* c = component;
  (void)tolerance_defined; /* what is left to choose is `accuracy`, of the samples between which is
                              interpolated */
  (void)tolerance;
  if (!may(c, kInstantiated, "fmi2SetupExperiment")) return fmi2Error;
  if (!isfinite(start) || (stop_defined && !(stop >= start)))
    return failed(c, "fmi2SetupExperiment", "the times are no interval");
  c->start = c->time = start;
  c->stop_defined = stop_defined;
  c->stop = stop;
  c->set_up = 1;
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) {
  Instance* c = component;
  if (!may(c, kInstantiated, "fmi2EnterInitializationMode")) return fmi2Error;
  if (!c->set_up) return failed(c, "fmi2EnterInitializationMode", "not before fmi2SetupExperiment");
  c->state = kInitialising;
  return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component) {
  Instance* c = component;
  if (!may(c, kInitialising, "fmi2ExitInitializationMode")) return fmi2Error;
  const fmi2Status status = begin(c, "fmi2ExitInitializationMode");
  if (status == fmi2OK) c->state = kStepping;
  return status;
}

fmi2Status fmi2Terminate(fmi2Component component) {
  Instance* c = component;
  if (!may(c, kStepping, "fmi2Terminate")) return fmi2Error;
  c->state = kTerminated;
  return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component component) {
  Instance* c = component;
  if (!may(c, kAny, "fmi2Reset")) return fmi2Error;
  forget(c); /* parameters may become others; the cache makes the same ones ready at once */
  start_values(c);
  c->state = kInstantiated;
  return fmi2OK;
}

/* ---- Values. */
static int known(const Instance* c, const fmi2ValueReference which[], size_t count, size_t all,
                 const void* values, const char* where) {
  if (count > 0 && (!which || !values)) return failed(c, where, "an array is missing"), 0;
  for (size_t i = 0; i < count; ++i)
    if (which[i] >= all) return failed(c, where, "there is no variable of this value reference"), 0;
  return 1;
}

/* Outputs while the instance is initialised are of the inputs as they are. */
static fmi2Status readable(Instance* c, const char* where) {
  if (!may(c, kInitialising | kStepping | kTerminated, where)) return fmi2Error;
  return c->state == kInitialising && c->dirty ? begin(c, where) : fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference which[], size_t count,
                       fmi2Real values[]) {
  Instance* c = component;
  if (!may(c, kInitialising | kStepping | kTerminated, "fmi2GetReal") ||
      !known(c, which, count, kReals, values, "fmi2GetReal"))
    return fmi2Error;
  for (size_t i = 0; i < count; ++i)
    if (which[i] >= kFx && which[i] <= kUncertainty && readable(c, "fmi2GetReal") != fmi2OK)
      return fmi2Error;
  for (size_t i = 0; i < count; ++i) values[i] = c->real[which[i]];
  return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component component, const fmi2ValueReference which[], size_t count,
                          fmi2Integer values[]) {
  Instance* c = component;
  if (readable(c, "fmi2GetInteger") != fmi2OK ||
      !known(c, which, count, kIntegers, values, "fmi2GetInteger"))
    return fmi2Error;
  for (size_t i = 0; i < count; ++i) values[i] = c->integer[which[i]];
  return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component component, const fmi2ValueReference which[], size_t count,
                          fmi2Boolean values[]) {
  Instance* c = component;
  if (readable(c, "fmi2GetBoolean") != fmi2OK ||
      !known(c, which, count, kBooleans, values, "fmi2GetBoolean"))
    return fmi2Error;
  for (size_t i = 0; i < count; ++i) values[i] = c->boolean[which[i]];
  return fmi2OK;
}

fmi2Status fmi2GetString(fmi2Component component, const fmi2ValueReference which[], size_t count,
                         fmi2String values[]) {
  Instance* c = component;
  if (!may(c, kInitialising | kStepping | kTerminated, "fmi2GetString") ||
      !known(c, which, count, kStrings, values, "fmi2GetString"))
    return fmi2Error;
  for (size_t i = 0; i < count; ++i) values[i] = c->directory;
  return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference which[], size_t count,
                       const fmi2Real values[]) {
  static const char* const where = "fmi2SetReal";
  Instance* c = component;
  if (!may(c, kInstantiated | kInitialising | kStepping, where) ||
      !known(c, which, count, kReals, values, where))
    return fmi2Error;
  for (size_t i = 0; i < count; ++i) { /* all or none */
    if (!isfinite(values[i])) return failed(c, where, "a value is not finite");
    if (which[i] <= kZ && fabs(values[i]) > kLargestPosition)
      return failed(c, where,
                    "a position beyond 10 m; are these millimetres? divide lengths by 1000");
    if (which[i] >= kFx && which[i] <= kUncertainty)
      return failed(c, where, "an output is not set");
    if (which[i] > kUncertainty && c->state == kStepping)
      return failed(c, where,
                    "a parameter is fixed once the instance is initialised; fmi2Reset comes first");
  }
  for (size_t i = 0; i < count; ++i) {
    if (which[i] > kUncertainty && c->real[which[i]] != values[i]) forget(c);
    c->real[which[i]] = values[i];
    c->dirty = 1;
  }
  return fmi2OK;
}

static fmi2Status outputs_alone(Instance* c, const char* where) {
  return c ? failed(c, where, "no variable of this type is set from outside") : fmi2Error;
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference which[], size_t count,
                          const fmi2Integer values[]) {
  (void)which, (void)values;
  return c && count == 0 ? fmi2OK : outputs_alone(c, "fmi2SetInteger");
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference which[], size_t count,
                          const fmi2Boolean values[]) {
  (void)which, (void)values;
  return c && count == 0 ? fmi2OK : outputs_alone(c, "fmi2SetBoolean");
}

fmi2Status fmi2SetString(fmi2Component component, const fmi2ValueReference which[], size_t count,
                         const fmi2String values[]) {
  Instance* c = component;
  if (!may(c, kInstantiated | kInitialising, "fmi2SetString") ||
      !known(c, which, count, kStrings, values, "fmi2SetString"))
    return fmi2Error;
  for (size_t i = 0; i < count; ++i) {
    char* path = values[i] ? copied(values[i]) : NULL;
    if (!path) return failed(c, "fmi2SetString", "a text is missing");
    free(c->directory);
    c->directory = path;
    forget(c);
  }
  return fmi2OK;
}

/* ---- Steps. */
fmi2Status fmi2DoStep(fmi2Component component, fmi2Real from, fmi2Real step,
                      fmi2Boolean no_state_before) {
  static const char* const where = "fmi2DoStep";
  Instance* c = component;
  (void)no_state_before; /* it never goes back */
  if (!may(c, kStepping, where)) return fmi2Error;
  if (!(step > 0) || !isfinite(step)) return failed(c, where, "the step is not above 0");
  /* Importers add steps up; what that rounds is less than a millionth of a step. */
  if (!(fabs(from - c->time) <= 1e-6 * step + 1e-12 * fabs(c->time)))
    return failed(c, where, "it does not begin where the last step ended");
  if (c->stop_defined && from + step > c->stop + 1e-6 * step + 1e-12 * fabs(c->stop))
    return failed(c, where, "it ends after the stop time of fmi2SetupExperiment");
  step_to(c, from + step);
  return fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c) {
  return c ? failed(c, "fmi2CancelStep", "a step is done when fmi2DoStep returns") : fmi2Error;
}

fmi2Status fmi2GetRealStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Real* value) {
  Instance* c = component;
  if (!may(c, kStepping | kTerminated, "fmi2GetRealStatus")) return fmi2Error;
  if (kind != fmi2LastSuccessfulTime || !value) return fmi2Discard;
  *value = c->time;
  return fmi2OK;
}
fmi2Status fmi2GetBooleanStatus(fmi2Component component, const fmi2StatusKind kind,
                                fmi2Boolean* value) {
  Instance* c = component;
  if (!may(c, kStepping | kTerminated, "fmi2GetBooleanStatus")) return fmi2Error;
  if (kind != fmi2Terminated || !value) return fmi2Discard;
  *value = fmi2False;
  return fmi2OK;
}
/* Of steps that go on in the background, which there are none of. */
fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status* value) {
  (void)kind, (void)value;
  return c ? fmi2Discard : fmi2Error;
}
fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer* value) {
  (void)kind, (void)value;
  return c ? fmi2Discard : fmi2Error;
}
fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String* value) {
  (void)kind, (void)value;
  return c ? fmi2Discard : fmi2Error;
}

/* ---- What modelDescription.xml says that it cannot. */
static fmi2Status unable(Instance* c, const char* where) {
  return c ? failed(c, where, "modelDescription.xml says that this FMU cannot") : fmi2Error;
}
fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  (void)state;
  return unable(c, "fmi2GetFMUstate");
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  (void)state;
  return unable(c, "fmi2SetFMUstate");
}
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  (void)state;
  return unable(c, "fmi2FreeFMUstate");
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  (void)state, (void)size;
  return unable(c, "fmi2SerializedFMUstateSize");
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[],
                                 size_t size) {
  (void)state, (void)bytes, (void)size;
  return unable(c, "fmi2SerializeFMUstate");
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate* state) {
  (void)bytes, (void)size, (void)state;
  return unable(c, "fmi2DeSerializeFMUstate");
}
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[],
                                        size_t unknown_count, const fmi2ValueReference known_ones[],
                                        size_t known_count, const fmi2Real seed[],
                                        fmi2Real values[]) {
  (void)unknown, (void)unknown_count, (void)known_ones, (void)known_count, (void)seed, (void)values;
  return unable(c, "fmi2GetDirectionalDerivative");
}
fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference which[],
                                       size_t count, const fmi2Integer order[],
                                       const fmi2Real values[]) {
  (void)which, (void)count, (void)order, (void)values;
  return unable(c, "fmi2SetRealInputDerivatives");
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference which[],
                                        size_t count, const fmi2Integer order[],
                                        fmi2Real values[]) {
  (void)which, (void)count, (void)order, (void)values;
  return unable(c, "fmi2GetRealOutputDerivatives");
}
