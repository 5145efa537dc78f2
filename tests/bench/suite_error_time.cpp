// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `error_time`: run time against error.

#include "host_tools/encode/extract.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/judged_queries.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/suites.hpp"
#include "transport/store/model_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Answer of a contestant for one point, in the model frame.
struct SurfaceAnswer
{
    double distance_m{0.0}; ///< Distance; not finite if nothing is within the contestant's band.
    Vec3 nearest_m{0.0, 0.0, 0.0};
    bool has_nearest{false};
};

/// Errors of answers against the truth.
struct AnswerErrors
{
    Spread distance_diag; ///< Errors of the distance, see TrueAnswers::errors_of().
    Spread normal_deg;    ///< Errors of the normal, of answers with a nearest point.
    /// Errors of the force of a penalty spring, 500 N/m on an object of 0.2 m. An answer without a
    /// nearest point has no force.
    Spread force_n;
    TouchErrors touch;
    std::uint64_t hash{0}; ///< Hash of the answers' bits.
};

/// Points of a motion with the true distances and nearest points of the whole mesh.
class TrueAnswers
{
public:
    TrueAnswers(const test::FaceTree& tree, double diagonal_m, std::vector<Vec3> points_m,
                double radius_m);

    [[nodiscard]] const Questions& questions() const { return questions_; }
    [[nodiscard]] double radius_m() const { return radius_m_; }
    /// Errors of one answer for each point. Distances beyond the radius, also true ones, count as
    /// the radius: only the penetration depth is judged.
    [[nodiscard]] AnswerErrors errors_of(const std::vector<SurfaceAnswer>& answers) const;

private:
    [[nodiscard]] Vec3 force_n(std::size_t point, const SurfaceAnswer& answer) const;

    Questions questions_;
    std::vector<SurfaceAnswer> truth_;
    double radius_m_;
    double diagonal_m_;
};

constexpr double kObject_m = 0.2;
constexpr double kErrorStiffness_n_per_m = 500.0;
/// Answers within this of the radius may report a touch or not.
constexpr double kTolerance_diag = 2e-6;
/// Closer to the surface, the direction of an answer has no meaning.
constexpr double kNoDirection_diag = 1e-4;

double angle_deg(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

/// Answer of Tactus: the proven nearest point, or the middle of the bounds.
SurfaceAnswer answer_of(const PairOutput& pair)
{
    if (!pair.nearest_face.is_none())
    {
        return {(pair.point_m - pair.nearest_point_m).norm(), pair.nearest_point_m, true};
    }
    const bool is_bounded = std::isfinite(pair.upper_m);
    return {is_bounded ? 0.5 * (pair.lower_m + pair.upper_m) : pair.lower_m, Vec3(0.0, 0.0, 0.0),
            false};
}

/// Answers of a peer, one for each question.
std::vector<SurfaceAnswer> answers_of(const PointAnswers& answers)
{
    std::vector<SurfaceAnswer> all;
    for (std::size_t i = 0; i < answers.distances_m.size(); ++i)
    {
        const double distance_m = answers.distances_m[i];
        all.push_back({distance_m, answers.nearest_m[i], std::isfinite(distance_m)});
    }
    return all;
}

TrueAnswers::TrueAnswers(const test::FaceTree& tree, double diagonal_m, std::vector<Vec3> points_m,
                         double radius_m)
    : radius_m_(radius_m), diagonal_m_(diagonal_m)
{
    questions_.points_m = std::move(points_m);
    for (const Vec3& point_m : questions_.points_m)
    {
        const auto nearest = tree.nearest(point_m);
        truth_.push_back({nearest.distance_m, nearest.point_m, true});
        questions_.truth_m.push_back(nearest.distance_m);
    }
}

AnswerErrors TrueAnswers::errors_of(const std::vector<SurfaceAnswer>& answers) const
{
    AnswerErrors errors;
    std::vector<double> distances_m;
    std::vector<double> off_diag;
    std::vector<double> normals_deg;
    std::vector<double> forces_n;
    for (std::size_t i = 0; i < truth_.size(); ++i)
    {
        const SurfaceAnswer& truth = truth_[i];
        const SurfaceAnswer& answer = answers[i];
        distances_m.push_back(answer.distance_m);
        off_diag.push_back(std::abs(std::min(answer.distance_m, radius_m_) -
                                    std::min(truth.distance_m, radius_m_)) /
                           diagonal_m_);
        if (answer.has_nearest && truth.distance_m > kNoDirection_diag * diagonal_m_)
        {
            const Vec3& point_m = questions_.points_m[i];
            normals_deg.push_back(angle_deg(point_m - answer.nearest_m, point_m - truth.nearest_m));
        }
        forces_n.push_back((force_n(i, answer) - force_n(i, truth)).norm());
        errors.hash += std::bit_cast<std::uint64_t>(answer.distance_m) * (2 * i + 1);
    }
    errors.distance_diag = spread_of(off_diag);
    errors.normal_deg = spread_of(normals_deg);
    errors.force_n = spread_of(forces_n);
    errors.touch =
        judge_touch(distances_m, questions_.truth_m, radius_m_, kTolerance_diag * diagonal_m_);
    return errors;
}

Vec3 TrueAnswers::force_n(std::size_t point, const SurfaceAnswer& answer) const
{
    const double depth_m = radius_m_ - answer.distance_m;
    if (!answer.has_nearest || !(depth_m > 0.0) || !(answer.distance_m > 0.0))
    {
        return {0.0, 0.0, 0.0};
    }
    const Vec3 outward = (questions_.points_m[point] - answer.nearest_m) / answer.distance_m;
    return outward * (kErrorStiffness_n_per_m * depth_m * kObject_m / diagonal_m_);
}

constexpr double kErrorTimeSpeed_diag_per_s = 0.5;
constexpr std::uint32_t kErrorTimeSplits = 64;
constexpr std::uint32_t kLatency_ms = 4;
/// Part of the rows that cannot be compared with the peers'.
constexpr const char* kOthers = "Other motions and models";
/// Reach of a tool in radii: slightly more than its radius and its motion in a frame.
constexpr double kReach = 1.1;

struct ErrorTimeCase
{
    SceneSource scene;
    double pool_mib; ///< Pools of the settings that vary something else.
};
/// One configuration of ours: its differences from the usual one.
struct Setting
{
    std::string name;
    bool is_quick;
    std::function<void(FrameRun&)> change{[](FrameRun&) {}};
    double speed_diag_per_s{kErrorTimeSpeed_diag_per_s};
    double radius_diag{kRadius_diag};

    /// True if the peers have the same motion.
    [[nodiscard]] bool is_of_the_motion() const
    {
        return speed_diag_per_s == kErrorTimeSpeed_diag_per_s && radius_diag == kRadius_diag;
    }
};

/// Figures of one point of the plane.
struct ErrorTimeFigures
{
    std::string name;
    Spread us;
    double bytes{0.0};
    AnswerErrors errors;
};

void set_latency(FrameRun& run, std::uint32_t latency_ms)
{
    run.rig.chunk_loader_steps_per_frame = 1; // One poll is one frame.
    run.rig.faults.delay_polls_min = run.rig.faults.delay_polls_max = latency_ms;
}

Setting with_splits(std::uint32_t splits, bool is_quick)
{
    return {fmt::format("K {}", splits), is_quick,
            [splits](FrameRun& run) { run.budgets.splits = run.budgets.merges = splits; }};
}

Setting with_tolerance(double tolerance_diag, bool is_quick)
{
    return {fmt::format("tolerance {:g} diag", tolerance_diag), is_quick, [=](FrameRun& run) {
                run.rig.variant.tolerance_m = tolerance_diag * run.scene.model.diagonal_m;
            }};
}

Setting with_fixed_radius(double factor, bool is_quick)
{
    return {fmt::format("radius {:g} x reach", factor), is_quick,
            [factor](FrameRun& run) { run.rig.variant.fixed_radius = factor; }};
}

Setting with_probe(double radius_diag)
{
    return {fmt::format("probe {:g} diag", radius_diag), false, [](FrameRun&) {},
            kErrorTimeSpeed_diag_per_s, radius_diag};
}

Setting with_speed(double speed_diag_per_s)
{
    return {fmt::format("{:g} diag/s", speed_diag_per_s), false, [](FrameRun&) {},
            speed_diag_per_s};
}

Setting with_cache(double mib)
{
    return {fmt::format("cache {:g} MiB", mib), false,
            [mib](FrameRun& run) { run.rig.cache_bytes = static_cast<std::size_t>(mib * 0x1p20); }};
}

Setting with_pools(double mib, bool is_quick)
{
    return {fmt::format("pools {:g} MiB", mib), is_quick,
            [mib](FrameRun& run) { run.rig.pool_bytes = static_cast<std::size_t>(mib * 0x1p20); }};
}

Setting with_latency(std::uint32_t latency_ms, double loss, bool is_quick)
{
    return {loss > 0.0 ? fmt::format("{} ms, {:g} % lost", latency_ms, 100.0 * loss)
                       : fmt::format("{} ms", latency_ms),
            is_quick,
            [=](FrameRun& run)
            {
                set_latency(run, latency_ms);
                run.rig.faults.loss = loss;
            }};
}

/// Nothing streams: the tool's first frames load and refine the whole model.
Setting whole_model()
{
    return {"whole model, static", true,
            [](FrameRun& run)
            {
                run.rig.pool_bytes = static_pool_bytes(run.scene);
                run.rig.static_when_it_fits = true;
            }};
}

/// All settings; `pool_mib` is the usual size of the pools.
std::vector<Setting> all_settings(double pool_mib)
{
    return {{"usual", true},
            with_splits(1, true),
            with_splits(4, false),
            with_splits(16, true),
            with_splits(256, false),
            with_tolerance(1e-5, false),
            with_tolerance(1e-4, true),
            with_tolerance(1e-3, false),
            with_fixed_radius(0.5, false),
            with_fixed_radius(1.0, true),
            with_fixed_radius(2.0, false),
            with_probe(0.003),
            with_probe(0.03),
            with_speed(0.1),
            with_speed(2.0),
            with_cache(0.25),
            with_cache(0.5),
            with_pools(pool_mib / 4.0, false),
            with_pools(pool_mib / 2.0, true),
            with_latency(0, 0.0, false),
            with_latency(20, 0.0, true),
            with_latency(50, 0.0, false),
            with_latency(20, 0.05, false),
            whole_model()};
}

/// A slide without its lead-in.
std::vector<Vec3> counted(const std::vector<Vec3>& goals_m)
{
    return {goals_m.begin() + kApproachFrames, goals_m.end()};
}

/// Counted points of a slide with these figures, and their truth.
class Slides
{
public:
    Slides(const Scene& scene, std::uint32_t frames) : scene_(scene), frames_(frames) {}

    [[nodiscard]] const TrueAnswers& of(double speed_diag_per_s, double radius_diag)
    {
        const auto [at, is_new] = known_.try_emplace({speed_diag_per_s, radius_diag});
        if (is_new)
        {
            at->second.emplace(*scene_.tree, scene_.model.diagonal_m,
                               counted(slide_motion(scene_.touch(), speed_diag_per_s, frames_)),
                               radius_diag * scene_.model.diagonal_m);
        }
        return *at->second;
    }

private:
    const Scene& scene_;
    std::uint32_t frames_;
    std::map<std::pair<double, double>, std::optional<TrueAnswers>> known_;
};

/// Rounding of double precision is not an error.
double beyond_rounding(double error)
{
    constexpr double kRounding = 1e-12;
    return error < kRounding ? 0.0 : error;
}

void add_figures(CaseRows& rows, const ErrorTimeFigures& figures)
{
    const AnswerErrors& errors = figures.errors;
    rows.add("p50", figures.us.p50, "us");
    rows.add("p99", figures.us.p99, "us");
    rows.add("max", figures.us.max, "us");
    rows.add("memory", figures.bytes * 1e-6, "MB");
    rows.add("error p99", beyond_rounding(errors.distance_diag.p99), "diag");
    rows.add("error max", beyond_rounding(errors.distance_diag.max), "diag");
    rows.add("normal p99", errors.normal_deg.p99, "deg");
    rows.add("force error p99", beyond_rounding(errors.force_n.p99), "N");
    rows.add("force error max", beyond_rounding(errors.force_n.max), "N");
    rows.add("missed", static_cast<double>(errors.touch.missed), "");
    rows.add("invented", static_cast<double>(errors.touch.invented), "");
}

void add_streaming(CaseRows& rows, const FrameReplay& replay, double diagonal_m)
{
    std::vector<double> widths_diag;
    double exact = 0.0;
    for (const PairOutput& pair : replay.answers())
    {
        exact += pair.kind == AnswerKind::exact ? 1.0 : 0.0;
        widths_diag.push_back((pair.upper_m - pair.lower_m) / diagonal_m);
    }
    const FrameWork& work = replay.work();
    rows.add("bounds p99", spread_of(widths_diag).p99, "diag");
    rows.add("exact", 100.0 * exact / static_cast<double>(work.frames), "%");
    rows.add("wire", work.per_frame(work.coded_bytes) * 1e-3 / kPeriod_s, "kB/s");
}

class ErrorTime
{
public:
    ErrorTime(const CaseContext& context, const ErrorTimeCase& test_case, const Scene& scene)
        : context_(context)
        , test_case_(test_case)
        , scene_(scene)
        , frames_(context.options.frames_or(3'000, 400))
        , slides_(scene, frames_)
    {
    }

    void run()
    {
        for (const Setting& setting : all_settings(test_case_.pool_mib))
        {
            if (setting.is_quick || !context_.options.quick)
            {
                run_ours(setting);
            }
        }
        for (const std::uint32_t bits : {kMinPositionBits, kMaxPositionBits})
        {
            run_position_bits(bits);
        }
        if (context_.options.count)
        {
            return; // Figures of ours only.
        }
        const auto decoded = decode_all(needed(ModelStore::open(scene_.model.path)));
        const std::size_t whole = scene_.model.faces.size();
        for (const std::size_t faces : {std::size_t{1'000}, std::size_t{3'000}, std::size_t{10'000},
                                        std::size_t{30'000}, std::size_t{100'000}, whole})
        {
            if (faces <= whole)
            {
                const auto coarse =
                    faces == whole
                        ? scene_.model.faces
                        : faces_of(
                              extract(decoded, {static_cast<std::uint32_t>(faces), {}, {}}).mesh,
                              scene_.model.origin_m);
                run_peers(coarse);
            }
        }
    }

private:
    [[nodiscard]] CaseRows rows_of(const char* part, const std::string& by,
                                   const std::string& setting, std::uint64_t hash) const
    {
        Row common = context_.common_row(scene_.model.name, part);
        common.by = by;
        common.setting = setting;
        common.frames = frames_;
        common.hash = hash;
        return {context_.rows, common};
    }

    void run_ours(const Setting& setting)
    {
        const TrueAnswers& truth = slides_.of(setting.speed_diag_per_s, setting.radius_diag);
        const auto figures =
            measure(scene_, setting, truth, setting.is_of_the_motion() ? "" : kOthers);
        if (setting.is_of_the_motion())
        {
            ours_.push_back(figures);
        }
    }

    /// Model of `bits`, judged by its source mesh: the cost of rounding.
    void run_position_bits(std::uint32_t bits)
    {
        auto named = source_mesh(test_case_.scene);
        named.name += bits == kMinPositionBits ? "" : fmt::format("-{}bit", bits);
        const Scene& scene = context_.scenes.get(named, bits);
        const std::vector<test::Face> source = faces_of(named.mesh, scene.model.origin_m);
        const test::FaceTree tree(source);
        const double diagonal_m = scene.model.diagonal_m;
        const TrueAnswers truth(
            tree, diagonal_m,
            counted(slide_motion({tree, diagonal_m}, kErrorTimeSpeed_diag_per_s, frames_)),
            kRadius_diag * diagonal_m);
        Setting setting{fmt::format("{} position bits, against the source", bits), true};
        measure(scene, setting, truth, kOthers);
    }

    /// Measures a setting; the tool is at the points of `truth`.
    ErrorTimeFigures measure(const Scene& scene, const Setting& setting, const TrueAnswers& truth,
                             const char* part)
    {
        FrameRun run = make_slide(scene, setting.speed_diag_per_s, kErrorTimeSplits,
                                  static_cast<std::size_t>(test_case_.pool_mib * 0x1p20), frames_);
        std::ranges::copy(truth.questions().points_m, run.goals_m.begin() + kApproachFrames);
        ToolSpec& tool = run.rig.tools[0];
        tool.radius_m = truth.radius_m();
        tool.query_only = true; // The tool is at the peers' points.
        set_latency(run, kLatency_ms);
        setting.change(run);
        if (run.rig.static_when_it_fits)
        {
            stay_until_all_is_there(run);
        }
        FrameReplay replay(run);
        replay.run(context_.options.passes_or(4, 2));
        std::vector<SurfaceAnswer> answers;
        std::ranges::transform(replay.answers(), std::back_inserter(answers), answer_of);
        ErrorTimeFigures figures{setting.name, spread_of(replay.sum_us(CacheState::warm).least()),
                                 static_cast<double>(run.rig.pool_bytes), truth.errors_of(answers)};
        CaseRows rows = rows_of(part, "Tactus", setting.name, replay.hash() + figures.errors.hash);
        add_figures(rows, figures);
        add_streaming(rows, replay, scene.model.diagonal_m);
        return figures;
    }

    /// Adds uncounted frames at the first position, twice as many as refinement needs.
    void stay_until_all_is_there(FrameRun& run) const
    {
        const std::size_t frames = 2 * scene_.model.faces.size() / kErrorTimeSplits + 1'000;
        run.goals_m.insert(run.goals_m.begin(), frames, run.goals_m.front());
        run.lead_in += frames;
        run.rig.chunk_loader_steps_per_frame = 4;
        run.rig.faults = {};
    }

    void run_peers(const std::vector<test::Face>& faces)
    {
        const TrueAnswers& truth = slides_.of(kErrorTimeSpeed_diag_per_s, kRadius_diag);
        for (const PointPeer& peer : point_peers())
        {
            if (faces.size() > peer.most_faces)
            {
                continue;
            }
            auto built = build_peer(peer, faces, truth.radius_m());
            const std::vector<Vec3>& points_m = truth.questions().points_m;
            const std::vector<double> bands_m(points_m.size(), kReach * truth.radius_m());
            const auto answers =
                replay_queries(*built.query, points_m, bands_m, context_.options.passes_or(4, 2));
            ErrorTimeFigures figures;
            figures.us = spread_of(answers.us.least());
            figures.bytes = built.bytes;
            figures.errors = truth.errors_of(answers_of(answers));
            CaseRows rows =
                rows_of("", peer.name, fmt::format("{} faces", faces.size()), answers.hash);
            add_figures(rows, figures);
            add_verdict(rows, figures);
        }
    }

    /// Adds whether some setting of ours is as accurate and small in at most twice the time.
    void add_verdict(CaseRows& rows, const ErrorTimeFigures& peer) const
    {
        constexpr double kSlower = 2.0;
        constexpr double kRounding_diag = 1e-9;
        const auto better =
            std::ranges::find_if(ours_,
                                 [&](const ErrorTimeFigures& mine)
                                 {
                                     return mine.errors.distance_diag.max <=
                                                peer.errors.distance_diag.max + kRounding_diag &&
                                            mine.bytes <= peer.bytes &&
                                            mine.us.p99 <= kSlower * peer.us.p99;
                                 });
        Row& row = rows.add("ours as good within 2 x", better == ours_.end() ? 0.0 : 1.0, "", 1.0);
        row.is_least = true;
        if (better != ours_.end())
        {
            row.peer = better->name;
        }
    }

    const CaseContext& context_;
    const ErrorTimeCase& test_case_;
    const Scene& scene_;
    std::uint32_t frames_;
    Slides slides_;
    std::vector<ErrorTimeFigures> ours_; ///< Figures of the motion that the peers share.
};

/// A query-only tool slides over the model. Time against error, memory and bytes on the wire, for
/// every setting of ours, and for every peer over the whole mesh and over coarser ones of our
/// simplifier.
void run_error_time_case(const CaseContext& context, const ErrorTimeCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    ErrorTime(context, test_case, scene).run();
}

std::vector<Case> error_time_cases()
{
    const auto on = [](When when, const SceneSource& scene, double pool_mib) {
        return make_case(scene.name, when, run_error_time_case, ErrorTimeCase{scene, pool_mib});
    };
    using enum When;
    return {on(full_only, kFandisk, 2.0), on(always, kBunny, 2.0), on(full_only, kIgea, 2.0),
            on(full_only, kFineBunny, 4.0), on(named_only, kTiny, 1.0)};
}

} // namespace

Suite error_time_suite()
{
    return {"error_time", error_time_cases};
}

} // namespace tactus::bench
