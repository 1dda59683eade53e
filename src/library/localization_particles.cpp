#include "localization_particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cspace/localization/particles/integer_weights.hpp"
#include "cspace/localization/particles/modes.hpp"
#include "cspace/localization/particles/systematic.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "kernels/localization_particles.hpp"

namespace cspace::localization {

namespace {

constexpr std::size_t pack = float_lanes;
constexpr BinRule size_bins = {2.0, 36};        // of the rule for the number of particles (Fox 2003)
constexpr std::size_t least_per_thread = 1024;  // particles, some tens of microseconds

std::size_t round_up(std::size_t n) { return (n + pack - 1) / pack * pack; }

const WeightTable& weight_table() {
    static const WeightTable table;
    return table;
}

// L with L Lᵀ = P, rows of the lower triangle; directions without variance get a column of zeros.
std::array<double, 6> factor_covariance(const std::array<double, 9>& P) {
    std::array<double, 6> L = {};
    const auto at = [&](std::size_t i, std::size_t j) -> double& { return L[i * (i + 1) / 2 + j]; };
    constexpr double singular = 1e-12;  // rounding of a variance
    for (std::size_t j = 0; j < 3; ++j) {
        double square = P[4 * j];
        for (std::size_t k = 0; k < j; ++k) square -= at(j, k) * at(j, k);
        if (!(square > singular * P[4 * j])) continue;
        at(j, j) = std::sqrt(square);
        for (std::size_t i = j + 1; i < 3; ++i) {
            double product = P[3 * i + j];
            for (std::size_t k = 0; k < j; ++k) product -= at(i, k) * at(j, k);
            at(i, j) = product / at(j, j);
        }
    }
    return L;
}

struct Poses {
    std::vector<double> x, y;
    std::vector<Heading> headings;
    explicit Poses(std::size_t size)
        : x(filled_vector<double>(size)),
          y(filled_vector<double>(size)),
          headings(filled_vector<Heading>(size)) {}
};

// Beams in cells.
struct Beams {
    std::vector<float> x, y;
    Beams(const ScoreCells& map, std::span<const Point> ends) {
        constexpr double farthest = 1e6;  // cells, beyond every map
        const auto in_cells = [&](double at) {
            return float(std::clamp(at * map.per_metre, -farthest, farthest));
        };
        for (const Point& end : ends) x.push_back(in_cells(end.x)), y.push_back(in_cells(end.y));
    }
    int size() const { return int(x.size()); }
};

// The logarithms of the likelihoods of readings, and how well they fit.
class SightingModel {
  public:
    explicit SightingModel(const LandmarkSightings& readings) : readings_(readings) {}
    // Sum of logarithms, and the mean likelihood relative to that of a perfect reading.
    std::pair<double, double> judge(double x, double y, double angle) const {
        const PoseRow& mount = readings_.mount;
        const double c = std::cos(angle), s = std::sin(angle);
        const double from_x = x + c * mount[0] - s * mount[1], from_y = y + s * mount[0] + c * mount[1];
        double sum = 0, fit = 0;
        for (std::size_t k = 0; k < readings_.rows.size(); ++k) {
            const double likelihood = best_likelihood(k, from_x, from_y, angle + mount[2]);
            sum += std::log(likelihood + readings_.false_share), fit += likelihood;
        }
        return {sum, fit / double(std::max<std::size_t>(readings_.rows.size(), 1))};
    }

  private:
    const LandmarkSightings& readings_;

    double best_likelihood(std::size_t k, double x, double y, double angle) const {
        if (readings_.rows[k] >= 0)
            return likelihood_of(k, readings_.points[std::size_t(readings_.rows[k])], x, y, angle);
        double best = 0;
        for (const Point& point : readings_.points)
            best = std::max(best, likelihood_of(k, point, x, y, angle));
        return best;
    }
    double likelihood_of(std::size_t k, const Point& point, double x, double y, double angle) const {
        const double dx = point.x - x, dy = point.y - y;
        double square = 0;
        if (!std::isnan(readings_.ranges[k])) {
            const double error = (readings_.ranges[k] - std::hypot(dx, dy)) / readings_.range_sigma;
            square += error * error;
        }
        if (!std::isnan(readings_.bearings[k])) {
            const double error =
                short_way(readings_.bearings[k] - (std::atan2(dy, dx) - angle)) / readings_.bearing_sigma;
            square += error * error;
        }
        return std::exp(-0.5 * square);
    }
};

}  // namespace

struct ScoreMap::State {
    std::vector<std::uint8_t> scores;
    ScoreCells cells;
};

ScoreMap::ScoreMap(maps::CellBytes given, double resolution, Point origin, int outside)
    : state_(std::make_unique<State>()) {
    const std::size_t columns = std::size_t(given.columns), stride = columns + 2;
    state_->scores = filled_vector<std::uint8_t>(stride * std::size_t(given.rows + 2), std::uint8_t(outside));
    for (std::size_t row = 0; row < std::size_t(given.rows); ++row)
        std::copy_n(given.data + row * columns, columns, &state_->scores[(row + 1) * stride + 1]);
    state_->cells = {state_->scores.data(), given.rows, given.columns, int(stride), origin.x, origin.y,
                     1 / resolution};
}
ScoreMap::~ScoreMap() = default;

struct ParticleCloud::State {
    std::size_t most, size = 0;
    DrawKey key;
    std::uint32_t steps = 0;  // draws so far
    Poses now, spare;
    std::vector<std::int32_t> logs;
    std::vector<std::uint32_t> weights;
    std::vector<std::int32_t> sums;

    State(std::size_t n, std::uint64_t seed)
        : most(n),
          key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}},
          now(round_up(n)),
          spare(round_up(n)),
          logs(filled_vector<std::int32_t>(n)),
          weights(filled_vector<std::uint32_t>(n)),
          sums(filled_vector<std::int32_t>(round_up(n))) {}

    // body(first, count) over whole packs.
    template <class Body>
    void over_packs(int threads, const Body& body) const {
        over_rows(round_up(size), threads, pack, least_per_thread, [&](std::size_t begin, std::size_t end) {
            body(begin, int(end - begin));
            return true;
        });
    }
    void level_weights() {
        visit_range(0, size, [&](std::size_t i) { logs[i] = 0, weights[i] = ~0u; });
    }
    // Adds log(i) to the logarithms [units], makes the largest zero, and the weights of them.
    template <class Log>
    void add(const Log& log) {
        std::int64_t best = std::numeric_limits<std::int64_t>::min();
        const auto sum = [&](std::size_t i) { return logs[i] + log(i); };
        visit_range(0, size, [&](std::size_t i) { best = std::max(best, sum(i)); });
        const WeightTable& table = weight_table();
        visit_range(0, size, [&](std::size_t i) {
            logs[i] = std::int32_t(std::max<std::int64_t>(sum(i) - best, least_log));
            weights[i] = table.weight_of(logs[i]);
        });
    }
    std::uint64_t total_weight() const {
        std::uint64_t total = 0;
        visit_range(0, size, [&](std::size_t i) { total += weights[i]; });
        return total;
    }
    std::uint64_t draw_word() {
        const FourWords drawn = draw_words({{0, 0, steps++, 1}}, key);
        return std::uint64_t(drawn.word[0]) << 32 | drawn.word[1];
    }
    std::int32_t score(const ScoreMap& map, std::span<const Point> ends, int threads) {
        const ScoreCells& cells = map.state().cells;
        const Beams beams(cells, ends);
        over_packs(threads, [&](std::size_t begin, int count) {
            kernels::score_particles(cells, &now.x[begin], &now.y[begin], &now.headings[begin], count,
                                     beams.x.data(), beams.y.data(), beams.size(), &sums[begin]);
        });
        std::int32_t best = 0;
        visit_range(0, size, [&](std::size_t i) { best = std::max(best, sums[i]); });
        return best;
    }
};

ParticleCloud::ParticleCloud(std::size_t most, std::uint64_t seed)
    : state_(std::make_unique<State>(most, seed)) {}
ParticleCloud::~ParticleCloud() = default;
std::size_t ParticleCloud::size() const { return state_->size; }
std::size_t ParticleCloud::most() const { return state_->most; }

void ParticleCloud::place(std::span<const PoseRow> poses) {
    State& s = *state_;
    if (poses.size() > s.most) throw std::invalid_argument("more poses than particles");
    s.size = poses.size();
    visit_range(0, s.size, [&](std::size_t i) {
        s.now.x[i] = poses[i][0], s.now.y[i] = poses[i][1], s.now.headings[i] = heading_of(poses[i][2]);
    });
    s.level_weights();
}

void ParticleCloud::move(const PoseRow& increment, const std::array<double, 9>& covariance, int threads) {
    State& s = *state_;
    MotionStep step;
    step.x = float(increment[0]), step.y = float(increment[1]);
    step.turn = heading_of(increment[2]);
    step.cosine = float(std::cos(increment[2])), step.sine = float(std::sin(increment[2]));
    const std::array<double, 6> L = factor_covariance(covariance);
    for (std::size_t k = 0; k < L.size(); ++k) step.noise[k] = float(L[k]);
    step.seed = s.key, step.number = s.steps++;
    s.over_packs(threads, [&](std::size_t begin, int count) {
        kernels::move_particles(step, begin, count, &s.now.x[begin], &s.now.y[begin], &s.now.headings[begin]);
    });
}

double ParticleCloud::add_scan(const ScoreMap& map, std::span<const Point> ends, double exponent,
                               int threads) {
    constexpr double top = 255;
    State& s = *state_;
    if (ends.empty() || !s.size) return 0;
    const double best = s.score(map, ends, threads);
    const std::int64_t unit = std::llround(exponent * log_units);
    if (unit > 0) s.add([&](std::size_t i) { return unit * s.sums[i]; });
    return best / (top * double(ends.size()));
}

Table<double> ParticleCloud::score(const ScoreMap& map, std::span<const Point> ends, int threads) {
    constexpr double top = 255;
    State& s = *state_;
    s.score(map, ends, threads);
    Table<double> scores;
    scores.values.resize(s.size);
    const double per_sum = 1 / (top * double(std::max<std::size_t>(ends.size(), 1)));
    visit_range(0, s.size, [&](std::size_t i) { scores.values[i] = per_sum * s.sums[i]; });
    return scores;
}

void ParticleCloud::add_logs(std::span<const double> logs) {
    State& s = *state_;
    if (logs.size() != s.size) throw std::invalid_argument("a logarithm per particle is needed");
    constexpr double least = -1e6;  // a likelihood of zero
    s.add([&](std::size_t i) {
        return std::int64_t(std::llround(std::max(std::isnan(logs[i]) ? least : logs[i], least) * log_units));
    });
}

double ParticleCloud::add_sightings(const LandmarkSightings& readings, double exponent, int threads) {
    State& s = *state_;
    std::vector<double> logs(s.size), fits(s.size);
    const SightingModel model(readings);
    over_rows(s.size, threads, 1, least_per_thread, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto [log, fit] = model.judge(s.now.x[i], s.now.y[i], angle_of(s.now.headings[i]));
            logs[i] = exponent * log, fits[i] = fit;
        }
        return true;
    });
    add_logs(logs);
    return fits.empty() ? 0 : *std::max_element(fits.begin(), fits.end());
}

double ParticleCloud::effective_count() const {
    const State& s = *state_;
    // Squares of 20-bit weights add up in 64 bits.
    constexpr int cut = 12;
    std::uint64_t sum = 0, squares = 0;
    visit_range(0, s.size, [&](std::size_t i) {
        const std::uint64_t w = s.weights[i] >> cut;
        sum += w, squares += w * w;
    });
    return squares ? double(sum) * double(sum) / double(squares) : 0;
}

std::size_t ParticleCloud::resample(std::size_t least, double error, double z) {
    State& s = *state_;
    const std::uint64_t total = s.total_weight(), random = s.draw_word();
    BinTable bins;
    SystematicDraws all(total, s.most, random);
    std::uint64_t bound = 0;
    visit_range(0, s.size, [&](std::size_t i) {
        bound += s.weights[i];
        if (all.count_below(bound))
            bins.number_of(size_bins.bin_of(s.now.x[i], s.now.y[i], s.now.headings[i]));
    });
    const double wanted = std::ceil(count_for_bins(bins.size(), error, z));
    const std::size_t n =
        std::clamp(std::size_t(std::min(wanted, double(s.most))), std::min(least, s.most), s.most);
    SystematicDraws draws(total, n, random);
    std::size_t made = 0;
    bound = 0;
    visit_range(0, s.size, [&](std::size_t i) {
        bound += s.weights[i];
        for (std::size_t copies = draws.count_below(bound); copies > 0; --copies, ++made) {
            s.spare.x[made] = s.now.x[i], s.spare.y[made] = s.now.y[i];
            s.spare.headings[made] = s.now.headings[i];
        }
    });
    std::swap(s.now, s.spare);
    s.size = made;
    s.level_weights();
    return bins.size();
}

std::tuple<Table<double>, Table<double>, Table<double>> ParticleCloud::find_modes() const {
    const State& s = *state_;
    const std::vector<PoseMode> modes =
        find_pose_modes({std::span(s.now.x).first(s.size), std::span(s.now.y).first(s.size),
                         std::span(s.now.headings).first(s.size), std::span(s.weights).first(s.size)});
    const double total = double(std::max<std::uint64_t>(s.total_weight(), 1));
    std::tuple<Table<double>, Table<double>, Table<double>> made{{{}, 3}, {{}, 9}, {{}, 0}};
    auto& [poses, covariances, shares] = made;
    for (const PoseMode& mode : modes) {
        poses.values.insert(poses.values.end(), mode.pose.begin(), mode.pose.end());
        covariances.values.insert(covariances.values.end(), mode.covariance.begin(), mode.covariance.end());
        shares.values.push_back(double(mode.weight) / total);
    }
    return made;
}

Table<double> ParticleCloud::poses() const { return poses(0, state_->size); }

Table<double> ParticleCloud::heaviest() const {
    const auto& weights = state_->weights;
    const auto end = weights.begin() + std::ptrdiff_t(state_->size);
    const std::size_t best = std::size_t(std::max_element(weights.begin(), end) - weights.begin());
    return poses(best, best + 1);
}

Table<double> ParticleCloud::poses(std::size_t begin, std::size_t end) const {
    const State& s = *state_;
    Table<double> table{{}, 3};
    end = std::min(end, s.size);
    table.values.reserve(end > begin ? 3 * (end - begin) : 0);
    visit_range(std::min(begin, end), end, [&](std::size_t i) {
        for (const double value : {s.now.x[i], s.now.y[i], angle_of(s.now.headings[i])})
            table.values.push_back(value);
    });
    return table;
}

Table<double> ParticleCloud::weights() const {
    const State& s = *state_;
    Table<double> table;
    table.values.resize(s.size);
    const double total = double(std::max<std::uint64_t>(s.total_weight(), 1));
    visit_range(0, s.size, [&](std::size_t i) { table.values[i] = double(s.weights[i]) / total; });
    return table;
}

Table<double> ParticleCloud::draw_normals(std::size_t count) {
    State& s = *state_;
    Table<double> table{std::vector<double>(3 * round_up(count)), 3};
    const std::uint32_t number = s.steps++;
    for (std::size_t i = 0; i < round_up(count); i += pack) {
        Floats normal[4];
        cspace::draw_normals(i, number, s.key, normal);
        for (std::size_t k = 0; k < 3; ++k) {
            float values[pack];
            store_floats(values, normal[k]);
            for (std::size_t lane = 0; lane < pack; ++lane)
                table.values[3 * (i + lane) + k] = double(values[lane]);
        }
    }
    table.values.resize(3 * count);
    return table;
}

Table<std::uint32_t> draw_counter_words(std::span<const std::uint32_t> counter,
                                        std::span<const std::uint32_t> key) {
    if (counter.size() != 4 || key.size() != 2) throw std::invalid_argument("counter (4,), key (2,)");
    const FourWords drawn =
        draw_words({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
    return {{drawn.word, drawn.word + 4}, 0};
}

double count_particles_for_bins(std::size_t bins, double error, double z) {
    return count_for_bins(bins, error, z);
}

}  // namespace cspace::localization
