// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `growth`: growth of the costs with the model.

#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr double kGrowthSpeed_diag_per_s = 0.5;
constexpr std::uint32_t kGrowthSplits = 128;
constexpr std::size_t kPool_bytes = 8 * kMiB;

/// Faces of a model, and splits of a frame on it.
struct Size
{
    double n;
    double k;
};

struct Figure
{
    const char* name;
    const char* unit;
    double (*law)(const Size& size); ///< Expected law, up to a factor.
    std::vector<double> values{};
};

double logarithm(const Size& size)
{
    return std::log2(size.n);
}

double linear(const Size& size)
{
    return size.n;
}

/// Law of the 3DIM 2005 paper for k faces that change together.
double clustered(const Size& size)
{
    return size.k * (std::log2(size.n) - std::log2(size.k) + 2.0);
}

/// Figures with their laws. The tool covers a share of the surface, a new one in each frame: the
/// work there grows with n, the path to it with log n.
std::vector<Figure> all_figures()
{
    return {{"frame p50", "us", linear},
            {"frame p99", "us", linear},
            {"query p50", "us", logarithm},
            {"splits", "/frame", linear},
            {"refit visits", "/frame", clustered},
            {"faces in the pool", "", linear},
            {"pages in the pool", "", linear},
            {"wire", "kB/s", linear},
            {"encoder", "s", linear},
            {"file", "MB", linear}};
}

/// Seconds on one core from the mesh to the file, and the file's bytes.
std::pair<double, double> encode(const NamedMesh& named)
{
    const test::TemporaryFolder folder("growth");
    const BenchClock::time_point start = BenchClock::now();
    const auto prepared = needed(prepare_mesh(named.mesh, {}));
    const auto simplification = needed(simplify(prepared.mesh, {}));
    const auto path = folder.path() / "model.spm";
    needed(write_spm(path, prepared, simplification, {}));
    return std::pair(seconds(start, BenchClock::now()),
                     static_cast<double>(std::filesystem::file_size(path)));
}

/// Law, scaled to pass through the geometric mean of the points.
std::vector<double> fitted_law(const Figure& figure, const std::vector<Size>& sizes)
{
    std::vector<double> law;
    double sum = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
        law.push_back(figure.law(sizes[i]));
        sum += std::log(figure.values[i] / law.back());
    }
    const double factor = std::exp(sum / static_cast<double>(sizes.size()));
    std::ranges::transform(law, law.begin(), [factor](double value) { return factor * value; });
    return law;
}

struct SizeFigures
{
    Size size;
    std::string scene;
    std::uint64_t hash{0};
    std::vector<double> values;
};

SizeFigures measure(const CaseContext& context, std::uint32_t faces, std::uint32_t frames)
{
    const auto named = source_mesh({"", nullptr, 0, faces});
    const Scene& scene = context.scenes.get(named);
    const PinnedCore pinned(context.options.core);
    const FrameRun run =
        make_slide(scene, kGrowthSpeed_diag_per_s, kGrowthSplits, kPool_bytes, frames);
    FrameReplay replay(run);
    replay.run(context.options.passes_or(4, 2));
    const auto encoded = encode(named);
    const Spread frame = spread_of(replay.sum_us(CacheState::warm).least());
    const FrameWork& work = replay.work();
    const double splits = work.per_frame(work.counters.splits);
    return SizeFigures{{static_cast<double>(scene.model.faces.size()), splits},
                       scene.model.name,
                       replay.hash(),
                       {frame.p50, frame.p99, spread_of(replay.stage_us(Stage::query).least()).p50,
                        splits, work.per_frame(work.refit_visits()),
                        static_cast<double>(work.model.faces.used_max),
                        static_cast<double>(work.model.pages.used_max),
                        work.per_frame(work.coded_bytes) * 1e-3 / kPeriod_s, encoded.first,
                        encoded.second * 1e-6}};
}

/// Exponent b of the power law a n^b, by least squares of the logarithms.
double fitted_exponent(const std::vector<double>& n, const std::vector<double>& values)
{
    const auto count = static_cast<double>(n.size());
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    for (std::size_t i = 0; i < n.size(); ++i)
    {
        const double at = std::log(n[i]);
        const double value = std::log(values[i]);
        x += at;
        y += value;
        xx += at * at;
        xy += at * value;
    }
    return (count * xy - x * y) / (count * xx - x * x);
}

struct GrowthLawCase
{
    /// Faces of the bumpy spheres in quick runs, ascending.
    std::vector<std::uint32_t> quick_faces;
    std::vector<std::uint32_t> faces; ///< Faces without --quick.
};
/// Cost of a slide and of encoding on one surface with increasing numbers of faces, and the
/// exponent of n for each figure in the power law of best fit.
void run_growth_law_case(const CaseContext& context, const GrowthLawCase& test_case)
{
    const std::uint32_t frames = context.options.frames_or(3'000, 500);
    std::vector<Figure> figures = all_figures();
    std::vector<SizeFigures> measured;
    std::vector<Size> sizes;
    std::vector<double> n;
    for (const std::uint32_t faces :
         context.options.quick ? test_case.quick_faces : test_case.faces)
    {
        auto at_size = measure(context, faces, frames);
        for (std::size_t i = 0; i < figures.size(); ++i)
        {
            if (!(at_size.values[i] > 0.0))
            {
                throw Failure(fmt::format("{}: nothing to fit an exponent to at {} faces",
                                          figures[i].name, faces));
            }
            figures[i].values.push_back(at_size.values[i]);
        }
        sizes.push_back(at_size.size);
        n.push_back(at_size.size.n);
        measured.push_back(std::move(at_size));
    }
    for (const Figure& figure : figures)
    {
        const std::vector<double> law = fitted_law(figure, sizes);
        for (std::size_t i = 0; i < n.size(); ++i)
        {
            Row common = context.common_row(measured[i].scene, figure.name);
            common.test_case = measured[i].scene;
            common.frames = frames;
            common.hash = measured[i].hash;
            CaseRows rows(context.rows, common);
            rows.add("faces", n[i], "");
            rows.add(figure.name, figure.values[i], figure.unit);
            rows.add("law", law[i], figure.unit);
        }
        Row common = context.common_row(context.name, "Exponents of n");
        common.test_case = figure.name;
        CaseRows rows(context.rows, common);
        rows.add("fitted", fitted_exponent(n, figure.values), "n^");
        rows.add("of the law", fitted_exponent(n, law), "n^");
    }
}

std::vector<Case> growth_cases()
{
    return {make_case("sizes", When::always, run_growth_law_case,
                      GrowthLawCase{{4'000, 10'000, 40'000, 100'000},
                                    {4'000, 40'000, 400'000, 4'000'000}}),
            make_case("tiny", When::named_only, run_growth_law_case,
                      GrowthLawCase{{2'000, 4'000}, {2'000, 4'000}})};
}

} // namespace

Suite growth_suite()
{
    return {"growth", growth_cases};
}

} // namespace tactus::bench
