#pragma once

#include "measure/heap.h"

#include <cstdint>
#include <string>

namespace sandflow {

/// How far two heights of the same sand differ, in mean grain diameters d.
struct HeightDifference {
    double mean = 0.0;       ///< d, mean |dH| weighted with area
    double rms = 0.0;        ///< d
    double bias = 0.0;       ///< d, mean of H_b - H_a
    double worst = 0.0;      ///< d, largest |dH|
    std::size_t places = 0;  ///< annuli or cells compared: where either heap is over 1.5 d
};

/// Heap b against heap a; differences are b minus a.
struct HeapComparison {
    HeapFigures a;
    HeapFigures b;
    double diameter = 0.0;                   ///< d, m
    HeightDifference radial;                 ///< annuli 1 d wide, each heap about its centroid
    HeightDifference cells;                  ///< squares 5 d wide, both heaps where they lie
    double centroidShift = 0.0;              ///< d, distance of the centroids; 0 if either
                                             ///< heap is empty
    double apexDifference = 0.0;             ///< d
    std::optional<double> reposeDifference;  ///< deg; none unless both heaps have an angle
    double r90Difference = 0.0;              ///< % of a's; 0 if a has none
    double footDifference = 0.0;             ///< d
    double volumeDifference = 0.0;           ///< % of a's; 0 if a has none
    std::int64_t countDifference = 0;        ///< grains
};

/// Compares two heaps on a floor level at `floorZ` [m]. Throws InputError if their grains differ in
/// mean radius: a difference in d would then mean nothing.
HeapComparison compareHeaps(const Snapshot& a, const Snapshot& b, double floorZ = 0.0);

/// The same on any floor: what is compared is then the depth of sand. Needed wherever the floor is
/// not level, for a place that is bare in one heap only has the floor's height.
HeapComparison compareHeaps(const Snapshot& a, const Snapshot& b, const FloorHeight& floor);

/// A table for people, with units, ends in a line break.
std::string describe(const HeapComparison& comparison);

}  // namespace sandflow
