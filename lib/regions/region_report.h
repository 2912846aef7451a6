// Regions as tables, a drawing and sentences.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "regions/region_map.h"

namespace hapsim {

// CSV line,region_a,region_b,point,x,y: `keys` points along each boundary in plan view [m].
void write_boundary(std::ostream& out, const std::vector<BoundaryLine>& lines, int keys);

// CSV node,left,right,height,size,inconsistency: the merges in their order; samples are the nodes
// below.
void write_dendrogram(std::ostream& out, const Dendrogram& tree);

// The tree as a drawing (SVG): brackets over the samples from left to right, coloured within a
// region and grey above.
std::string dendrogram_svg(const RegionEstimate& regions);

// How the samples were divided, why or why not, and the values of each region.
std::vector<std::string> region_lines(const RegionEstimate& regions, std::size_t samples);

}  // namespace hapsim
