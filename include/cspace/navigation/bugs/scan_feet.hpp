// Where walls are nearest in a scan with noise: runs of beams that read little more than the least.
#pragma once

#include <optional>

#include "cspace/navigation/bugs/clearance_sensor.hpp"
#include "cspace/navigation/bugs/scanner.hpp"

namespace cspace::navigation {

// A run of beams that read about the same, the nearest there are around; beam numbers continue past a full
// circle.
struct Near {
    int first, last;
    Point towards;  // unit
};

class ScanFeet {
  public:
    static constexpr double slack = 0.03, trust = 3.5;  // of the distance, and of a reading's deviation
    static constexpr double grazing = 8;  // a wall is seen at up to this secant of the angle of incidence
    static constexpr int apart = Scanner::beams / 12;  // runs of one wall lie no farther from each other

    ScanFeet(const Scanner& scanner, const Scan& scan) : scanner_(scanner), scan_(scan) {}

    double at(int beam) const { return scan_.reading[std::size_t(wrapped(beam))]; }
    double tolerance(double distance) const { return slack * distance + trust * scan_.deviation; }
    static int wrapped(int beam) { return (beam % Scanner::beams + Scanner::beams) % Scanner::beams; }
    static int beam_of(Point towards) {
        const double turns = std::atan2(towards.y, towards.x) / (2 * std::numbers::pi);
        return wrapped(int(std::lround(turns * Scanner::beams)));
    }
    // How many beams it is from one counterclockwise to another.
    static int ahead(int from, int to) { return wrapped(to - from); }

    bool returns(int beam) const { return at(beam) < scanner_.range(); }

    // Whether between two beams, counterclockwise, there is nothing that the scan does not show.
    bool is_closed(int first, int last) const {
        for (int k = first; k < last; ++k)
            if (jumps(k)) return false;
        return true;
    }

    // The beam that reads least, of some.
    int nearest(int first, int last) const {
        int best = first;
        for (int k = first; k <= last; ++k)
            if (smooth(k) < smooth(best)) best = k;
        return best;
    }
    // The mean of neighbours where the view does not jump: less noise, and less of the luck of the least.
    double smooth(int beam) const {
        double sum = at(beam), count = 1;
        if (!jumps(beam)) sum += at(beam + 1), ++count;
        if (!jumps(beam - 1)) sum += at(beam - 1), ++count;
        return sum / count;
    }

    // Counterclockwise, all walls within a distance. Runs are one unless they lie far apart or the view opens
    // between them.
    std::vector<Near> within(double distance) const {
        std::vector<Near> runs;
        int begin = 0;
        while (begin < Scanner::beams && is_near(begin, distance)) ++begin;
        if (begin == Scanner::beams)
            return {{0, Scanner::beams - 1, direction_of(0, Scanner::beams - 1, distance)}};
        for (int k = begin; k < begin + Scanner::beams; ++k) {
            if (!is_near(k, distance)) continue;
            if (!runs.empty() && is_one(runs.back().last, k))
                runs.back().last = k;
            else
                runs.push_back({k, k, {}});
        }
        if (runs.size() > 1 && is_one(runs.back().last, runs.front().first + Scanner::beams)) {
            runs.front().first = runs.back().first - Scanner::beams;
            runs.pop_back();
        }
        for (Near& run : runs) run.towards = direction_of(run.first, run.last, distance);
        return runs;
    }

  private:
    const Scanner& scanner_;
    const Scan& scan_;

    bool is_near(int beam, double distance) const { return returns(beam) && at(beam) <= distance; }
    bool is_one(int last, int next) const { return next - last < apart && is_closed(last, next); }
    // Whether the view opens between a beam and the next one.
    bool jumps(int beam) const {
        if (!returns(beam) || !returns(beam + 1)) return true;
        const double a = at(beam), b = at(beam + 1);
        const double step = 2 * std::numbers::pi / Scanner::beams * std::min(a, b);
        return std::abs(a - b) > grazing * step + 2 * trust * scan_.deviation;
    }
    Point direction_of(int first, int last, double distance) const {
        Point sum;
        for (int k = first; k <= last; ++k)
            if (at(k) <= distance) sum = sum + (distance - at(k) + 1e-3 * distance) * scanner_.direction(k);
        const double size = norm(sum);
        return size > 0 ? (1 / size) * sum : scanner_.direction((first + last) / 2);
    }
};

}  // namespace cspace::navigation
