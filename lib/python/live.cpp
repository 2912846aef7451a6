#include "python/live.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "python/convert.h"
#include "python/options.h"
#include "python/prepared.h"

namespace hapsim::python {
namespace {

// Three numbers, of an array of numpy without a copy.
struct Vector {
  explicit Vector(const py::handle& given) {
    if (py::isinstance<py::array_t<double>>(given)) {
      const auto array = py::reinterpret_borrow<py::array_t<double>>(given);
      if (array.ndim() == 1 && array.size() == 3) {
        for (py::ssize_t k = 0; k < 3; ++k) values[static_cast<std::size_t>(k)] = *array.data(k);
        return;
      }
    }
    values = py::cast<std::array<double, 3>>(given);
  }
  std::array<double, 3> values;
};

class Live {
 public:
  Live(Prepared prepared, const py::kwargs& keywords) : prepared_(std::move(prepared)) {
    const Options options(keywords);
    hs_live* made = nullptr;
    require(hs_live_new(prepared_.handle.get(), options.get(), &made));
    live_ = owned<hs_live, hs_live_free>(made);
  }

  py::array_t<double> step(const py::handle& position, const py::handle& t) {
    const Vector at(position);
    py::array_t<double> force(3);
    hs_live_step(live_.get(), time_of(t), at.values.data(), force.mutable_data());
    return force;
  }
  py::array_t<double> run(const py::array_t<double>& t, const py::array_t<double>& positions) {
    const auto times = t.unchecked<1>();
    const auto at = positions.unchecked<2>();
    if (at.shape(0) != times.shape(0) || at.shape(1) != 3)
      fail(HS_BAD_INPUT, "there are " + std::to_string(times.shape(0)) +
                             " times; give a position of three numbers for each");
    py::array_t<double> forces({at.shape(0), py::ssize_t{3}});
    double* out = forces.mutable_data();
    for (py::ssize_t i = 0; i < at.shape(0); ++i) {
      const double tip[3] = {at(i, 0), at(i, 1), at(i, 2)};
      hs_live_step(live_.get(), times(i), tip, out + 3 * i);
    }
    return forces;
  }
  static py::array_t<double> step_all(const std::vector<Live*>& tools, double t,
                                      const py::array_t<double>& positions) {
    const auto at = positions.unchecked<2>();
    if (at.shape(0) != static_cast<py::ssize_t>(tools.size()) || at.shape(1) != 3)
      fail(HS_BAD_INPUT, "there are " + std::to_string(tools.size()) +
                             " tools; give a position of three numbers for each");
    std::vector<hs_live*> lives;
    std::vector<double> tips;
    for (py::ssize_t i = 0; i < at.shape(0); ++i) {
      const Live* tool = tools[static_cast<std::size_t>(i)];
      if (tool == nullptr)
        fail(HS_BAD_INPUT, "tool " + std::to_string(i) + " is None; give a Live");
      lives.push_back(tool->live_.get());
      for (py::ssize_t k = 0; k < 3; ++k) tips.push_back(at(i, k));
    }
    py::array_t<double> forces({at.shape(0), py::ssize_t{3}});
    hs_live_step_all(lives.data(), lives.size(), t, tips.data(), forces.mutable_data());
    return forces;
  }
  void begin(const py::handle& contact) {
    hs_live_begin(live_.get(), Vector(contact).values.data());
  }
  py::array_t<double> press(const py::handle& u, const py::handle& t, bool in_air) {
    const Vector by(u);
    py::array_t<double> force(3);
    hs_live_press(live_.get(), time_of(t), by.values.data(), in_air ? 1 : 0, force.mutable_data());
    return force;
  }
  hs_feel feel() const {
    hs_feel now;
    hs_live_feel(live_.get(), &now);
    return now;
  }
  void set_temperature(double temperature) { hs_live_set_temperature(live_.get(), temperature); }
  void end() { hs_live_end(live_.get()); }

 private:
  // By the clock since the first step, where no time is given.
  double time_of(const py::handle& t) {
    if (!t.is_none()) return t.cast<double>();
    using Clock = std::chrono::steady_clock;
    const Clock::time_point now = Clock::now();
    if (!begun_) start_ = now;
    begun_ = true;
    return std::chrono::duration<double>(now - start_).count();
  }

  Prepared prepared_;
  std::shared_ptr<hs_live> live_;
  std::chrono::steady_clock::time_point start_;
  bool begun_ = false;
};

}  // namespace

void define_live(py::module_& m) {
  py::class_<Live>(m, "Live", "hs-simulate --live: one tool, a force within microseconds.")
      .def(py::init<Prepared, const py::kwargs&>(), "prepared"_a,
           "Keywords are the limits of a hand: hand=True, max_force=5.")
      .def(py::init([](const Body& body, const Model& model, const py::object& contacts,
                       const py::kwargs& keywords) {
             return Live(prepare(body, model, contacts, keywords), py::kwargs());
           }),
           "body"_a, "model"_a, "contacts"_a = py::none(), "Keywords are those of prepare().")
      .def("step", &Live::step, "position"_a, "t"_a = py::none(),
           "Force [N] on a tool with its tip at a position [m]; without t [s] by the clock.")
      .def("run", &Live::run, "t"_a, "positions"_a, "step() for each row; forces, n x 3")
      .def_static("step_all", &Live::step_all, "tools"_a, "t"_a, "positions"_a,
                  "step() of many tools at one time; forces, n x 3")
      .def("begin", &Live::begin, "contact"_a, "A recorded press, whose contact point is known.")
      .def("press", &Live::press, "u"_a, "t"_a, "in_air"_a = false,
           "Its force at a displacement u [m] from there.")
      .def_property_readonly("feel", &Live::feel)
      .def("set_temperature", &Live::set_temperature, "temperature"_a, "Of the body [degC].")
      .def("end", &Live::end, "Of a hand: zero from now on.");
}

}  // namespace hapsim::python
