// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Hours of a bad link in virtual time: a controller streams a model larger than its memory over a
/// link that loses, repeats, reorders, damages and swaps pieces, and loses and regains its server,
/// beside another controller that is added and removed. No answer is wrong, and at the quiet end of
/// each cycle all resources have been returned.

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/frame_verdict.hpp"
#include "tests/shared/sanitizers.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/hardships.hpp"
#include "tests/stability/random_motion.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <malloc.h>
#include <memory>
#include <string>
#include <unistd.h>

#if TACTUS_HAS_ADDRESS_SANITIZER || TACTUS_HAS_THREAD_SANITIZER
#define TACTUS_HEAP_IS_A_SANITIZER_S
/// Some compilers lack <sanitizer/allocator_interface.h>.
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace tactus::test
{
namespace
{

/// Frames of a cycle; at 1 kHz 600 cycles are an hour.
constexpr std::uint32_t kCycleFrames = 6'000;
constexpr std::uint32_t kUsualCycles = 12;
/// Cycles in which tables may grow to their working size.
constexpr std::uint32_t kWarmUpCycles = 4;
/// Growth of a quiet end over those of the warm-up: a few vectors that keep their largest size, 4
/// KB in an hour. One leaked chunk every third second is more within the usual cycles.
constexpr std::size_t kHeapSlack_bytes = 8'192;
/// Address space of a controller's pools is returned to the system; some small arenas of the C
/// library may vary.
constexpr std::size_t kSpaceSlack_bytes = std::size_t{4} << 20U;
constexpr double kToolRadius_diag = 0.01;
/// Pages for one touch, not for the model, so that the cache is replaced constantly.
constexpr std::size_t kPages = 100;

std::uint32_t cycles_to_run()
{
    const char* text = std::getenv("TACTUS_SOAK_CYCLES");
    return text == nullptr ? kUsualCycles
                           : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

/// Resources of the process.
struct Holdings
{
    std::size_t heap_bytes{0};
    std::size_t space_bytes{0}; ///< Address space; 0 if a sanitizer reserves all of it.
    std::size_t files{0};
};

Holdings holdings()
{
    Holdings held;
    const std::filesystem::directory_iterator files("/proc/self/fd");
    held.files = static_cast<std::size_t>(std::distance(begin(files), end(files)));
#ifdef TACTUS_HEAP_IS_A_SANITIZER_S
    held.heap_bytes = __sanitizer_get_current_allocated_bytes();
#else
    std::ifstream("/proc/self/statm") >> held.space_bytes;
    held.space_bytes *= static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const struct mallinfo2 heap = ::mallinfo2();
    held.heap_bytes = heap.uordblks + heap.hblkhd;
#endif
    return held;
}

RigOptions bad_weather(const TestModel& model, std::uint64_t seed)
{
    RigOptions options = with_tool({}, kToolRadius_diag * model.diagonal_m);
    options.cache_bytes = kPages * sizeof(Page);
    options.faults = {.seed = seed,
                      .loss = 0.05,
                      .duplicates = 0.05,
                      .damage = 0.02,
                      .mix_ups = 0.02,
                      .delay_polls_min = 4,
                      .delay_polls_max = 24};
    return options;
}

/// Events for the summary, and to fail a soak without any.
struct SoakFigures
{
    std::uint64_t frames{0};
    std::uint64_t answered{0};
    std::uint64_t contacts{0};
    std::uint64_t loads{0};
    std::uint64_t refused{0}; ///< Damaged or swapped pieces.
    std::uint64_t unasked{0}; ///< Includes duplicates.
    std::uint64_t asked_again{0};

    void operator+=(const ChunkLoaderCounters& counters)
    {
        loads += counters.delivered;
        refused += counters.refused();
        unasked += counters.dropped_unasked;
        asked_again += counters.asked_again;
    }
};

/// Controller with its link, a hand, and its judges.
struct Controller
{
    Controller(const TestModel& model, const CenterOracle& oracle, std::uint64_t seed,
               SoakFigures& figures)
        : model_(model)
        , oracle_(oracle)
        , figures_(figures)
        , random_(Random::seeded(seed))
        , motion_(model, oracle.tree(), kToolRadius_diag * model.diagonal_m, 1.0, random_)
        , rig_(model, bad_weather(model, seed))
    {
    }
    ~Controller() { figures_ += rig_.chunk_loader().counters(); }
    Controller(const Controller&) = delete;
    Controller& operator=(const Controller&) = delete;

    /// Steps once; returns the fault, if any.
    [[nodiscard]] Verdict step()
    {
        const Moment moment = motion_.next();
        rig_.place_object(moment.pose);
        return judge(rig_.step(moment.goal_m, budgets_), moment.pose);
    }

    /// Moves far away until nothing is in transit and all slots are in place.
    [[nodiscard]] Verdict come_to_rest()
    {
        constexpr std::uint32_t most = 6'000; // Frames: many times kRequestTimeoutFrames.
        const Vec3 far_off = to_world(rig_.pose(), Vec3(100.0 * model_.diagonal_m, 0.0, 0.0));
        std::uint32_t quiet =
            0; // Consecutive frames; late and unrequested pieces arrive in them too.
        for (std::uint32_t frame = 0; frame < most && quiet < 100; ++frame)
        {
            const FrameOutput output = rig_.step(far_off, budgets_);
            const bool is_quiet = output.work.requests == 0 && output.work.pages_adopted == 0 &&
                                  rig_.model().cache.requests_under_way() == 0;
            quiet = is_quiet ? quiet + 1 : 0;
        }
        if (quiet < 100)
        {
            return "the controller does not come to rest";
        }
        const FrameOutput output = rig_.step(far_off, budgets_);
        const ModelOutput& model = output.models[0];
        const ChunkLoader& chunk_loader = rig_.chunk_loader();
        if (chunk_loader.free_pages() + model.pages.used != model.pages.capacity ||
            chunk_loader.free_index_pages() + model.index_pages.used != model.index_pages.capacity)
        {
            return "slots are lost: " + std::to_string(chunk_loader.free_pages()) + " free and " +
                   std::to_string(model.pages.used) + " used of " +
                   std::to_string(model.pages.capacity);
        }
        return std::nullopt;
    }

    [[nodiscard]] LoopbackLink& link() { return rig_.link(); }

private:
    [[nodiscard]] Verdict judge(const FrameOutput& output, const ObjectPose& pose)
    {
        const PairOutput& pair = output.pairs[0];
        const Vec3& force_n = output.tools[0].force_n;
        ++figures_.frames;
        figures_.contacts += output.tools[0].in_contact ? 1U : 0U;
        figures_.answered +=
            pair.kind == AnswerKind::exact || pair.kind == AnswerKind::separated ? 1U : 0U;
        if (const BracketVerdict verdict = judge_bracket(oracle_, pair, pose); verdict.error > 1.0)
        {
            return verdict.text;
        }
        if (!(force_n.norm() <= kForceMax_n * (1.0 + 1e-12)))
        {
            return "a force of " + std::to_string(force_n.norm()) + " N";
        }
        const Verdict budget = broken_budget(output, budgets_);
        return budget ? budget : unexplained(output);
    }

    static constexpr double kForceMax_n = 8.0; ///< Value of with_tool().

    const TestModel& model_;
    const CenterOracle& oracle_;
    SoakFigures& figures_;
    Random random_;
    RandomMotion motion_;
    FrameRig rig_;
    Budgets budgets_;
};

/// One controller for the whole run, another one for a part of each cycle.
struct Soak
{
    Soak(const TestModel& model, const CenterOracle& oracle, std::uint64_t seed)
        : model_(model)
        , oracle_(oracle)
        , seed_(seed)
        , random_(Random::seeded(seed))
        , steady_(std::make_unique<Controller>(model, oracle, seed, figures_))
    {
    }

    /// Six seconds: the server is lost twice, for some time and briefly; the second controller is
    /// added and removed, with or without a server.
    void run_cycle(std::uint32_t cycle)
    {
        const std::uint32_t lost = 500 + random_.below(2'000U);
        const std::uint32_t found = lost + 300 + random_.below(1'500U);
        const std::uint32_t cut = 4'500 + random_.below(1'000U);
        const std::uint32_t mended = cut + 1 + random_.below(200U);
        const std::uint32_t comes = random_.below(4'000U);
        const std::uint32_t goes = comes + 1 + random_.below(1'500U);
        std::unique_ptr<Controller> streamed_model;
        for (std::uint32_t frame = 0; frame < kCycleFrames; ++frame)
        {
            if (frame == comes)
            {
                streamed_model =
                    std::make_unique<Controller>(model_, oracle_, seed_ + 1 + cycle, figures_);
            }
            streamed_model = frame == goes ? nullptr : std::move(streamed_model);
            if (frame == lost || frame == cut)
            {
                steady_->link().lose_server();
            }
            if (frame == found || frame == mended)
            {
                steady_->link().regain_server();
            }
            expect(steady_->step(), cycle, frame, "steady");
            if (streamed_model)
            {
                expect(streamed_model->step(), cycle, frame, "streamed_model");
            }
        }
        expect(steady_->come_to_rest(), cycle, kCycleFrames, "steady");
    }

    /// Figures, including those of the remaining controller.
    [[nodiscard]] SoakFigures finish()
    {
        steady_.reset();
        return figures_;
    }

private:
    void expect(const Verdict& verdict, std::uint32_t cycle, std::uint32_t frame, const char* who)
    {
        ASSERT_FALSE(verdict) << "TACTUS_SEED=" << seed_ << ", cycle " << cycle << ", frame "
                              << frame << ", " << who << ": " << *verdict;
    }

    const TestModel& model_;
    const CenterOracle& oracle_;
    std::uint64_t seed_;
    Random random_;
    SoakFigures figures_;
    std::unique_ptr<Controller> steady_;
};

/// TACTUS_SOAK_CYCLES of six seconds each.
TEST(Soak, in_bad_weather_no_answer_is_wrong_and_nothing_grows)
{
    const std::uint64_t seed = seed_of(20'261'122);
    const std::uint32_t cycles = cycles_to_run();
    ASSERT_GT(cycles, kWarmUpCycles) << "TACTUS_SOAK_CYCLES";
    const TestModel& model = test_model("soak", make_shape(Shape::bumpy_sphere, 20'000).value());
    const CenterOracle oracle(model);
    Soak sut(model, oracle, seed);
    Holdings first;
    Holdings last;
    for (std::uint32_t cycle = 0; cycle < cycles && !testing::Test::HasFailure(); ++cycle)
    {
        sut.run_cycle(cycle);
        last = holdings();
        if (cycle < kWarmUpCycles)
        {
            first.heap_bytes = std::max(first.heap_bytes, last.heap_bytes);
            first.space_bytes = std::max(first.space_bytes, last.space_bytes);
            first.files = std::max(first.files, last.files);
        }
        ASSERT_LE(last.heap_bytes, first.heap_bytes + kHeapSlack_bytes) << "cycle " << cycle;
        ASSERT_LE(last.space_bytes, first.space_bytes + kSpaceSlack_bytes) << "cycle " << cycle;
        ASSERT_LE(last.files, first.files) << "cycle " << cycle;
    }
    const SoakFigures figures = sut.finish();
    std::printf(
        "seed %llu: %llu frames, %llu answered, %llu in contact; %llu loads, %llu refused, "
        "%llu unrequested, %llu asked again; heap %zu to %zu bytes, space %zu to %zu KiB, %zu "
        "files\n",
        static_cast<unsigned long long>(seed), static_cast<unsigned long long>(figures.frames),
        static_cast<unsigned long long>(figures.answered),
        static_cast<unsigned long long>(figures.contacts),
        static_cast<unsigned long long>(figures.loads),
        static_cast<unsigned long long>(figures.refused),
        static_cast<unsigned long long>(figures.unasked),
        static_cast<unsigned long long>(figures.asked_again), first.heap_bytes, last.heap_bytes,
        first.space_bytes / 1024, last.space_bytes / 1024, last.files);
    EXPECT_GT(figures.answered, figures.frames / 4);
    EXPECT_GT(figures.contacts, figures.frames / 20);
    EXPECT_GT(figures.loads, 100 * std::uint64_t{cycles});
    EXPECT_GT(figures.refused, std::uint64_t{cycles});
    EXPECT_GT(figures.unasked, std::uint64_t{cycles});
    EXPECT_GT(figures.asked_again, std::uint64_t{cycles});
}

} // namespace
} // namespace tactus::test
