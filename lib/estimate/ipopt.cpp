#include "estimate/ipopt.h"

#include <coin/IpStdCInterface.h>
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <type_traits>

#include "base/error.h"

namespace hapsim {
namespace {

struct Calls {
  decltype(&CreateIpoptProblem) create = nullptr;
  decltype(&FreeIpoptProblem) free = nullptr;
  decltype(&AddIpoptStrOption) add_text = nullptr;
  decltype(&AddIpoptNumOption) add_number = nullptr;
  decltype(&AddIpoptIntOption) add_integer = nullptr;
  decltype(&SetIntermediateCallback) tell = nullptr;
  decltype(&IpoptSolve) solve = nullptr;
  bool complete = false;
};

Calls load() {
  Calls calls;
  void* library = dlopen(HAPSIM_IPOPT, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return calls;
  calls.complete = true;
  const auto find = [&](auto& call, const char* name) {
    call = reinterpret_cast<std::remove_reference_t<decltype(call)>>(dlsym(library, name));
    calls.complete = calls.complete && call != nullptr;
  };
  find(calls.create, "CreateIpoptProblem");
  find(calls.free, "FreeIpoptProblem");
  find(calls.add_text, "AddIpoptStrOption");
  find(calls.add_number, "AddIpoptNumOption");
  find(calls.add_integer, "AddIpoptIntOption");
  find(calls.tell, "SetIntermediateCallback");
  find(calls.solve, "IpoptSolve");
  return calls;
}

struct Run {
  IpoptProblemOf& problem;
  int iterations = 0;
  IpoptProblemOf& at(Index n, const Number* y) {
    problem.evaluate(Eigen::Map<const Eigen::VectorXd>(y, n));
    return problem;
  }
};

Run& run_of(UserDataPtr data) {
  return *static_cast<Run*>(data);
}

Bool value(Index n, Number* y, Bool, Number* f, UserDataPtr data) {
  *f = run_of(data).at(n, y).r.squaredNorm();
  return std::isfinite(*f) ? TRUE : FALSE;
}

Bool gradient(Index n, Number* y, Bool, Number* g, UserDataPtr data) {
  const IpoptProblemOf& p = run_of(data).at(n, y);
  Eigen::Map<Eigen::VectorXd>(g, n) = 2 * p.J.transpose() * p.r;
  return TRUE;
}

Bool constraints(Index n, Number* y, Bool, Index m, Number* g, UserDataPtr data) {
  IpoptProblemOf& p = run_of(data).problem;
  p.constrain(Eigen::Map<const Eigen::VectorXd>(y, n));
  Eigen::Map<Eigen::VectorXd>(g, m) = p.g;
  return p.g.allFinite() ? TRUE : FALSE;
}

Bool constraint_slopes(Index n, Number* y, Bool, Index m, Index, Index* row, Index* column,
                       Number* values, UserDataPtr data) {
  IpoptProblemOf& p = run_of(data).problem;
  if (values != nullptr && p.curves()) p.constrain(Eigen::Map<const Eigen::VectorXd>(y, n));
  for (Index c = 0, k = 0; c < m; ++c)
    for (Index i = 0; i < n; ++i, ++k) {
      if (values != nullptr) {
        values[k] = p.A(c, i);
      } else {
        row[k] = c;
        column[k] = i;
      }
    }
  return TRUE;
}

Bool curvature(Index n, Number* y, Bool, Number factor, Index m, Number* multipliers, Bool, Index,
               Index* row, Index* column, Number* values, UserDataPtr data) {
  Eigen::MatrixXd H;
  if (values != nullptr) {
    IpoptProblemOf& p = run_of(data).at(n, y);
    H = 2 * factor * p.J.transpose() * p.J;
    if (p.curves())
      p.bend(Eigen::Map<const Eigen::VectorXd>(y, n),
             Eigen::Map<const Eigen::VectorXd>(multipliers, m), H);
  }
  for (Index i = 0, k = 0; i < n; ++i)
    for (Index j = 0; j <= i; ++j, ++k) {
      if (values != nullptr) {
        values[k] = H(i, j);
      } else {
        row[k] = i;
        column[k] = j;
      }
    }
  return TRUE;
}

Bool count(Index, Index iteration, Number, Number, Number, Number, Number, Number, Number, Number,
           Index, UserDataPtr data) {
  run_of(data).iterations = iteration;
  return TRUE;
}

std::string message_of(ApplicationReturnStatus status) {
  switch (status) {
    case Solve_Succeeded:
      return "converged";
    case Solved_To_Acceptable_Level:
      return "converged to an acceptable level only";
    case Infeasible_Problem_Detected:
      return "no point keeps all constraints";
    case Maximum_Iterations_Exceeded:
      return "too many iterations";
    case Restoration_Failed:
      return "no way back to the constraints was found";
    case Invalid_Number_Detected:
      return "the start gives no finite forces";
    default:
      return "Ipopt stopped with status " + std::to_string(static_cast<int>(status));
  }
}

}  // namespace

IpoptEnd minimise_by_ipopt(IpoptProblemOf& problem, int max_iterations) {
  static std::mutex one_at_a_time;  // MUMPS keeps a state of its own
  const std::lock_guard lock(one_at_a_time);
  static const Calls calls = load();
  // No other method in its stead: the same fit must not depend on what is installed.
  if (!calls.complete)
    fail_io("Ipopt", HAPSIM_IPOPT " cannot be loaded, and a fit under constraints needs it",
            "install it (Debian: coinor-libipopt1v5)");
  IpoptEnd end;
  const auto n = static_cast<Index>(problem.y.size());
  const auto m = static_cast<Index>(problem.least.size());
  constexpr double kNone = 1e20;  // Ipopt's infinity is 1e19
  Eigen::VectorXd low = problem.low.cwiseMax(-kNone), high = problem.high.cwiseMin(kNone),
                  least = problem.least.cwiseMax(-kNone), most = problem.most.cwiseMin(kNone);
  const IpoptProblem ipopt =
      calls.create(n, low.data(), high.data(), m, least.data(), most.data(), n * m, n * (n + 1) / 2,
                   0, value, constraints, gradient, constraint_slopes, curvature);
  end.message = "Ipopt cannot start";
  if (ipopt == nullptr) return end;
  const auto set = [&](std::string key, std::string word) {
    calls.add_text(ipopt, key.data(), word.data());
  };
  const auto set_number = [&](std::string key, double v) {
    calls.add_number(ipopt, key.data(), v);
  };
  const auto set_integer = [&](std::string key, int v) { calls.add_integer(ipopt, key.data(), v); };
  set_integer("print_level", 0);
  set("sb", "yes");
  set_integer("max_iter", max_iterations);
  set_number("tol", 1e-9);
  // Bounds are kept exactly, so that logarithms stay defined.
  set_number("bound_relax_factor", 0);
  if (problem.curves()) {
    set_integer("acceptable_iter", 0);  // its acceptable level breaks constraints by a hundredth
  } else {
    set("jac_c_constant", "yes");
    set("jac_d_constant", "yes");
  }
  calls.tell(ipopt, count);
  Run run{problem};
  end.of_constraints = Eigen::VectorXd::Zero(m);
  end.of_low = end.of_high = Eigen::VectorXd::Zero(n);
  const ApplicationReturnStatus status =
      calls.solve(ipopt, problem.y.data(), nullptr, nullptr, end.of_constraints.data(),
                  end.of_low.data(), end.of_high.data(), &run);
  calls.free(ipopt);
  end.began = true;
  end.message = message_of(status);
  end.converged = status == Solve_Succeeded || status == Solved_To_Acceptable_Level;
  end.iterations = run.iterations;
  return end;
}

}  // namespace hapsim
