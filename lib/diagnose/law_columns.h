// Of what laws of what a model leaves are made: factors a sample, and what they act on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnose/law_samples.h"

namespace hapsim::law {

using Column = LawSamples::Column;
using Vectors = LawSamples::Vectors;
using Columns = std::vector<Vectors>;

// Knots, strictly increasing: at even shares of the samples, or of the range.
std::vector<double> quantiles(const Column& x, int count);
std::vector<double> even(const Column& x, int count);
// Piecewise linear, one at its knot and zero at the others.
std::vector<Column> hats(const Column& x, const std::vector<double>& knots);

// One where the press is that of its place (0 to 5), else zero; how far the force leans from the
// normal: its sine.
std::vector<Column> numbers(const LawSamples& samples);
Column slants(const LawSamples& samples);

// What a law may do that acts alike on all samples: gains along the normal and across it, those of
// each axis, a zero of each axis and along the normal.
Columns gains(const LawSamples& samples);
Columns gains_of_axes(const LawSamples& samples);
Columns zeros(const LawSamples& samples);
// What any 3 x 3 matrix of the force does; any of the motion, by the place's own stiffness along
// the normal and across it: of a sample that goes along the normal alone the one across is by the
// ratio of all.
Columns by_matrix(const LawSamples& samples);
Columns by_motion(const LawSamples& samples);

Columns join(Columns a, const Columns& b);
Columns times(const std::vector<Column>& factors, const Columns& what);
std::vector<Column> products(const std::vector<Column>& a, const std::vector<Column>& b);

// Of all samples kept (stacked [N]), a column each number. Of some recordings a law has none.
Eigen::MatrixXd stacked(const Columns& columns, const LawSamples& samples);

}  // namespace hapsim::law
