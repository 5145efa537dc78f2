// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `stability`: claims that must always hold, tried as often as time permits. Only errors are
/// measured; a violated claim causes exit code 1.

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/bench_report.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/kernel_trial.hpp"
#include "tests/shared/worst_shapes.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/day_trial.hpp"
#include "tests/stability/garbage_trial.hpp"
#include "tests/stability/mesh_trial.hpp"
#include "tests/stability/pop_through_trial.hpp"
#include "tests/stability/rigid_trial.hpp"
#include "tests/stability/scene_trial.hpp"
#include "tests/stability/twin_trial.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>

namespace tactus::bench
{

namespace
{

using test::TrialFigures;
using Report = std::function<void(const TrialFigures&)>;

/// Amounts of work of a run.
struct Sizes
{
    int kernel_cases;             ///< Cases of each of 15 classes.
    std::uint32_t bounded_frames; ///< Frames for each model and hardship.
    std::uint32_t twin_frames;    ///< Frames for each model.
    std::uint64_t operations;     ///< Splits and merges for each model.
    std::uint32_t touches;        ///< Touches of test::kTouchFrames frames of 1 ms.
    std::uint64_t press_frames;
    std::uint32_t garbage_frames;   ///< Frames for each kind.
    std::uint32_t mesh_frames;      ///< Frames for each object and hardship.
    std::uint32_t mesh_twin_frames; ///< Frames for each object.
    std::uint32_t proxy_frames;     ///< Frames for each model and hardship.
    std::uint32_t closing_rounds;
    std::uint32_t force_frames; ///< Frames for each model and hardship.
    std::uint32_t scene_frames; ///< Frames for each hardship.
    std::uint32_t rigid_frames; ///< Frames for each of 15 combinations of tool and object.
};

constexpr Sizes kSized{200, 100, 2'000, 100'000, 100, 50'000, 4'000,
                       40,  150, 40,    10,      500, 400,    400};
/// A million frames of bounds, of proxies with and without force shading, and of rigid tools; a
/// million cases of each kernel; ten million splits and merges; 24 hours of touching.
constexpr Sizes kFull{67'000, 4'000,  25'000, 2'500'000, 43'200, 3'600'000, 100'000,
                      1'000,  25'000, 3'600,  1'000,     10'000, 20'000,    70'000};

constexpr std::uint64_t kStabilitySeed = 20'261'600;

/// Available well-known meshes; the largest in full runs only.
std::vector<const test::TestModel*> known_models(bool full)
{
    std::vector<const test::TestModel*> models;
    for (const test::KnownMesh& mesh : test::kKnownMeshes)
    {
        const bool is_largest = &mesh == std::end(test::kKnownMeshes) - 1;
        const test::TestModel* model = full || !is_largest ? test::known_model(mesh) : nullptr;
        if (model != nullptr)
        {
            models.push_back(model);
        }
    }
    return models;
}

std::vector<const test::TestModel*> all_models(bool full)
{
    std::vector<const test::TestModel*> models = known_models(full);
    for (std::size_t i = 0; i < test::generated_model_count(); ++i)
    {
        models.push_back(&test::generated_model(i));
    }
    return models;
}

void try_kernels(const Sizes& sizes, bool /*full*/, const Report& report)
{
    for (const test::KernelTrial& trial : test::kernel_trials())
    {
        TrialFigures all;
        all.name = std::string("kernel of a ") + trial.name;
        all.unit = "of the law";
        test::Random random = test::Random::seeded(test::seed_of(kStabilitySeed));
        for (const test::PairClass& kind : test::pair_classes())
        {
            all.add(trial.run(kind, sizes.kernel_cases, random));
        }
        report(all);
    }
}

void try_brackets(const Sizes& sizes, bool full, const Report& report)
{
    std::uint64_t own = kStabilitySeed + 100;
    for (const test::TestModel* model : all_models(full))
    {
        const test::CenterOracle oracle(*model);
        TrialFigures all;
        all.name = "bounds, " + model->name;
        all.unit = "of an exact answer's bounds";
        for (const test::Hardship& hardship : test::hardships(*model))
        {
            const std::uint64_t seed = test::seed_of(++own);
            all.add(test::run_bracket_trial(
                        {*model, oracle.tree(), oracle, hardship, seed, sizes.bounded_frames})
                        .bounded);
        }
        report(all);
    }
}

/// Shows that the checks can fail: every model with false bounds must be found.
void try_liars(const Sizes& sizes, bool /*full*/, const Report& report)
{
    using test::lying_model;
    TrialFigures smaller{"liars not found, bounds a fifth smaller", 0, 0.0, 0.0, "models", 0, {}};
    TrialFigures without{"liars not found, coarse distance taken", 0, 0.0, 0.0, "models", 0, {}};
    const auto judge = [](TrialFigures& figures, const TrialFigures& lies)
    {
        ++figures.trials;
        if (lies.violations == 0)
        {
            figures.flag(lies.name + " passed");
        }
    };
    for (const Shape shape : {Shape::bumpy_sphere, Shape::torus, Shape::terrain})
    {
        const TriangleMesh mesh = make_shape(shape, 4'000).value();
        const std::string name(shape_names()[static_cast<std::size_t>(shape)]);
        judge(smaller, test::query_worst_points(lying_model(name + "-0.8", mesh, 0.8)));
        const test::TestModel& model = lying_model(name + "-0", mesh, 0.0);
        const test::CenterOracle oracle(model);
        judge(without, test::run_bracket_trial(
                           {model, oracle.tree(), oracle, test::hardship_named(model, "K-1"),
                            test::seed_of(kStabilitySeed), 10 * sizes.bounded_frames})
                           .bounded);
    }
    report(smaller);
    report(without);
}

void try_twins(const Sizes& sizes, bool full, const Report& report)
{
    std::vector<const test::TestModel*> models = known_models(full);
    for (std::size_t i = 0; i < 4; ++i)
    {
        models.push_back(&test::small_model(i));
    }
    for (const test::TestModel* model : models)
    {
        const test::FaceTree tree(model->faces);
        const test::TwinFigures figures =
            test::run_twin_trial({*model, tree, test::seed_of(kStabilitySeed), sizes.twin_frames});
        report(figures.identity);
        report(figures.cores);
        report(figures.uncertified);
    }
}

/// Mesh tools: torus, gear and bumpy sphere in turn.
void try_meshes(const Sizes& sizes, bool full, const Report& report)
{
    constexpr std::array<Shape, 3> kTools{Shape::torus, Shape::gear, Shape::bumpy_sphere};
    std::uint64_t own = kStabilitySeed + 500;
    std::vector<const test::TestModel*> objects = known_models(false);
    objects.resize(full ? objects.size() : 0);
    for (std::size_t i = 0; i < 4; ++i)
    {
        objects.push_back(&test::small_model(i));
    }
    for (std::size_t i = 0; i < objects.size(); ++i)
    {
        const test::TestModel& object = *objects[i];
        const Shape shape = kTools[i % kTools.size()];
        const std::string name(shape_names()[static_cast<std::size_t>(shape)]);
        const test::TestModel& tool =
            test::test_model("mesh-" + name, make_shape(shape, 1'000).value());
        const test::FaceTree tree(object.faces);
        TrialFigures truth;
        truth.name = "mesh tool on " + object.name;
        truth.bound = 0.0;
        truth.unit = "wrong frames";
        const double scale = 2.0 * tool.diagonal_m / object.diagonal_m;
        for (const char* hardship : {"usual", "K-1", "starved", "small-pools", "lossy-link"})
        {
            truth.add(
                test::run_mesh_trial({tool, object, tree, test::hardship_named(object, hardship),
                                      scale, test::seed_of(++own), sizes.mesh_frames})
                    .truth);
        }
        report(truth);
        report(test::run_mesh_twin({tool, object, tree, test::hardship_named(object, "usual"),
                                    scale, test::seed_of(++own), sizes.mesh_twin_frames}));
    }
}

void try_scenes(const Sizes& sizes, bool /*full*/, const Report& report)
{
    std::uint64_t own = kStabilitySeed + 3'000;
    const std::vector<const test::TestModel*> models = test::small_models();
    for (const char* hardship : {"usual", "K-1", "starved", "lossy-link", "late-link", "static"})
    {
        const test::SceneFigures figures =
            test::run_scene_trial({models, test::hardship_named(*models[0], hardship), 4,
                                   test::seed_of(++own), sizes.scene_frames});
        report(figures.truth);
        fmt::print(stderr, "{}: {} exact answers, {} changes refused\n", figures.truth.name,
                   figures.exact, figures.refused);
    }
}

void try_pop_through(const Sizes& sizes, bool full, const Report& report)
{
    std::uint64_t own = kStabilitySeed + 1'000;
    std::vector<const test::TestModel*> models = all_models(full);
    const test::TestModel& notched = test::test_model("notched-cube", test::make_notched_cube(12));
    models.push_back(&notched);
    const auto report_both = [&](const test::PopThroughFigures& all)
    {
        report(all.crossings);
        report(all.run_over);
        fmt::print(
            stderr,
            "{}: {} frames in contact, {} felt shaded, {} halted, {} over-constrained, {} run "
            "over\n",
            all.crossings.name, all.in_contact, all.felt_shaded, all.halted, all.over_constrained,
            all.run_over.trials);
    };
    for (const bool is_smooth : {false, true})
    {
        const std::string how = is_smooth ? ", smooth, " : ", ";
        for (const test::TestModel* model : models)
        {
            const test::FaceTree tree(model->faces);
            test::PopThroughFigures all;
            all.crossings.name = "pop-through" + how + model->name;
            all.crossings.unit = "frames";
            all.crossings.bound = 0.0;
            all.run_over = all.crossings;
            all.run_over.name = "run over and not told" + how + model->name;
            for (const test::Hardship& hardship : test::hardships(*model))
            {
                all.add(test::run_pop_through_trial(
                    {*model, tree, hardship, test::seed_of(++own), sizes.proxy_frames, is_smooth}));
            }
            report_both(all);
        }
        const test::FaceTree tree(notched.faces);
        report_both(test::run_closing_trial(
            {notched, tree, test::seed_of(++own), sizes.closing_rounds, is_smooth}));
    }
}

void try_rigid_tools(const Sizes& sizes, bool /*full*/, const Report& report)
{
    std::uint64_t own = kStabilitySeed + 3'000;
    for (const test::RigidStage stage : {test::RigidStage::still, test::RigidStage::turning,
                                         test::RigidStage::far, test::RigidStage::closing})
    {
        for (test::RigidTrial& trial : test::rigid_trials(stage))
        {
            trial.seed = test::seed_of(++own);
            trial.frames =
                stage == test::RigidStage::still ? sizes.rigid_frames : sizes.rigid_frames / 4;
            const test::RigidFigures figures = test::run_rigid_trial(trial);
            report(figures.crossings);
            if (stage == test::RigidStage::closing)
            {
                report(figures.steps);
            }
            fmt::print(
                stderr,
                "{}: {} frames in contact, {} halted, {} over-constrained, {} run over and told\n",
                figures.crossings.name, figures.contacts, figures.halted, figures.over_constrained,
                figures.run_over);
        }
    }
}

void try_force_twins(const Sizes& sizes, bool full, const Report& report)
{
    std::uint64_t own = kStabilitySeed + 2'000;
    std::vector<const test::TestModel*> models = known_models(full);
    for (std::size_t i = 0; i < 4; ++i)
    {
        models.push_back(&test::small_model(i));
    }
    for (const test::TestModel* model : models)
    {
        const test::FaceTree tree(model->faces);
        for (const std::uint32_t tools : {1U, 2U})
        {
            test::ForceTwinFigures all;
            all.steps = {"force step, " + model->name + (tools > 1 ? ", two tools" : ""),
                         0,
                         0.0,
                         test::kForceStep_n,
                         "N",
                         0,
                         {}};
            all.after_waits = all.steps;
            all.after_waits.name += ", after a wait";
            for (const test::Hardship& hardship : test::force_hardships(*model))
            {
                all.add(test::run_force_twin_trial(
                    {*model, tree, hardship, test::seed_of(++own), sizes.force_frames, tools}));
            }
            report(all.steps);
            report(all.after_waits);
            fmt::print(stderr,
                       "{}: {:.2g} N apart, {} frames of splits, {} of merges, {} of pages; {} "
                       "fading, {} data-limited with steps to {:.2g} N\n",
                       all.steps.name, all.apart_n, all.refining, all.coarsening, all.adopting,
                       all.fading, all.data_limited, all.data_limited_n);
        }
    }
}

void try_splits(const Sizes& sizes, bool /*full*/, const Report& report)
{
    for (std::size_t i = 0; i < 4; ++i)
    {
        report(test::run_split_merge_trial(test::small_model(i), sizes.operations,
                                           test::seed_of(kStabilitySeed)));
    }
}

void try_day(const Sizes& sizes, bool /*full*/, const Report& report)
{
    const test::TestModel& model = test::small_model(0);
    test::DayFigures day = test::run_day_trial(model, sizes.touches, test::seed_of(kStabilitySeed));
    day.returns.name += fmt::format(", {:.1f} h", day.simulated_s / 3'600.0);
    report(day.returns);
    report(day.creep);
    TrialFigures press =
        test::run_press_trial(model, sizes.press_frames, test::seed_of(kStabilitySeed));
    press.name += ", one press";
    report(press);
}

void try_garbage(const Sizes& sizes, bool /*full*/, const Report& report)
{
    const test::TestModel& model = test::small_model(0);
    const test::CenterOracle oracle(model);
    for (const test::Garbage& garbage : test::garbage_kinds())
    {
        TrialFigures figures = test::run_garbage_trial(model, oracle, garbage, sizes.garbage_frames,
                                                       test::seed_of(kStabilitySeed));
        figures.name = std::string("device garbage, ") + garbage.name;
        report(figures);
    }
    for (const test::Garbage& garbage : test::rigid_garbage_kinds())
    {
        TrialFigures figures = test::run_rigid_garbage_trial(garbage, sizes.garbage_frames / 4,
                                                             test::seed_of(kStabilitySeed));
        figures.name = std::string("device garbage, box, ") + garbage.name;
        report(figures);
    }
}

struct Part
{
    const char* name;
    void (*run)(const Sizes& sizes, bool full, const Report& report);
};

constexpr std::array<Part, 12> kParts{{{"kernels", try_kernels},
                                       {"brackets", try_brackets},
                                       {"liars", try_liars},
                                       {"twins", try_twins},
                                       {"meshes", try_meshes},
                                       {"scene", try_scenes},
                                       {"pop-through", try_pop_through},
                                       {"rigid", try_rigid_tools},
                                       {"force-twins", try_force_twins},
                                       {"splits", try_splits},
                                       {"day", try_day},
                                       {"garbage", try_garbage}}};

void run_part(const CaseContext& context, const Part& part)
{
    const bool is_full = context.options.full;
    (*part.run)(is_full ? kFull : kSized, is_full,
                [&](const TrialFigures& figures)
                {
                    for (const std::string& text : figures.texts)
                    {
                        fmt::print(stderr, "violation: {}\n", text);
                    }
                    add_trial_rows(figures, part.name, context.rows);
                });
}

std::vector<Case> all_parts()
{
    std::vector<Case> cases;
    for (const Part& part : kParts)
    {
        cases.push_back(make_case(part.name, When::always, run_part, part));
    }
    return cases;
}

} // namespace

Suite stability_suite()
{
    return {"stability", all_parts, true};
}

} // namespace tactus::bench
