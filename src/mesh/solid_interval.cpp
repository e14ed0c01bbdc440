#include "mesh/solid_interval.h"

namespace sandflow {

void dropSlivers(double minThickness, std::vector<SolidInterval>& stretches)
{
    std::size_t written = 0;
    for (std::size_t read = 0; read < stretches.size();) {
        SolidInterval whole = stretches[read++];
        while (read < stretches.size() && stretches[read].lo <= whole.hi) {
            whole.hi = stretches[read++].hi;
        }
        if (whole.hi - whole.lo >= minThickness) {
            stretches[written++] = whole;
        }
    }
    stretches.resize(written);
}

}  // namespace sandflow
