// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I7: the frame as the haptic thread runs it, streaming with all shortages, makes no heap calls
/// and no system calls. A build with the realtime sanitizer also ends at the first violation.

#include "host_tools/shapes/shapes.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/system_call_trap.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <thread>
#include <unistd.h>

namespace tactus::test
{
namespace
{

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
constexpr bool kHasRealtimeSanitizer = true;
#else
constexpr bool kHasRealtimeSanitizer = false;
#endif
#else
constexpr bool kHasRealtimeSanitizer = false;
#endif

/// Forbidden operations of frames, and evidence that they did any work.
struct Watched
{
    std::uint64_t heap_calls{0};
    std::uint64_t system_calls{0};
    WorkCounters work;
    std::string not_trapped; ///< Reason why system calls could not be counted; empty if they were.
};

/// Path of a tool: it hops between random corners of the model, around its middle, so that it lands
/// on new ground each time and is never caught inside. It begins in mid-air: a proxy that starts on
/// the surface stays there.
class Wander
{
public:
    Wander(const TestModel& model, std::uint32_t leg_frames, Random& random)
        : model_(model)
        , leg_frames_(leg_frames)
        , random_(random)
        , from_(random_corner())
        , to_(random_corner())
        , step_(leg_frames / 2)
    {
        for (const Face& face : model.faces)
        {
            middle_ += to_vec3(face[0]) / static_cast<double>(model.faces.size());
        }
    }

    Vec3 next()
    {
        if (step_ % leg_frames_ == 0)
        {
            from_ = to_;
            to_ = random_corner();
        }
        const double share = static_cast<double>(step_++ % leg_frames_) / leg_frames_;
        const Vec3 from = from_ - middle_;
        const Vec3 to = to_ - middle_;
        const Vec3 direction = ((1.0 - share) * from + share * to).normalized();
        const double height = (1.0 - share) * from.norm() + share * to.norm();
        return middle_ + (1.0 + 2.0 * share * (1.0 - share)) * height * direction;
    }

private:
    Vec3 random_corner() { return to_vec3(model_.faces[random_.below(model_.faces.size())][0]); }

    const TestModel& model_;
    std::uint32_t leg_frames_;
    Random& random_; ///< Shared, so that all paths differ.
    Vec3 middle_{0.0, 0.0, 0.0};
    Vec3 from_;
    Vec3 to_;
    std::uint32_t step_;
};

struct Touch
{
    RigOptions options;
    Budgets budgets;
    StageMark mark;
    std::uint32_t leg_frames{200};
    std::uint32_t frames{3'000};
    /// True if objects and tools are added, moved and removed; most of it is refused.
    bool scene_changes{false};
};

const TestModel& model_to_touch()
{
    static const TestModel& model =
        test_model("realtime", make_shape(Shape::bumpy_sphere, 20'000).value());
    return model;
}

void add_work(WorkCounters& sum, const WorkCounters& work)
{
    sum.splits += work.splits;
    sum.merges += work.merges;
    sum.pages_adopted += work.pages_adopted;
    sum.evictions += work.evictions;
}

/// Makes random changes of any kind; a thousand occasionally.
void make_changes(std::uint32_t frame, Random& random, std::vector<SceneChange>& changes)
{
    changes.resize(frame % 100 == 99 ? 1'000 : random.below(4U));
    for (SceneChange& change : changes)
    {
        change.kind = static_cast<SceneChangeKind>(random.below(kSceneChangeKinds));
        change.number = random.below(12U);
        change.generation = random.below(frame / 50 + 2);
        change.object.model = ModelId{random.below(2U)};
        change.pose.translation_m = random.in_cube(model_to_touch().diagonal_m);
        change.pose.scale = random.between(-0.5, 2.0);
    }
}

std::uint64_t heap_calls()
{
    const allocation_counter::HeapCalls calls = allocation_counter::of_this_thread();
    return calls.allocations + calls.frees;
}

/// Runs every frame with its warm-up, the only parts watched; the transport side is not.
void watch_frames(FrameRig& rig, const Touch& touch, Random& random, Watched& watched)
{
    const std::size_t tool_count = std::max<std::size_t>(touch.options.tools.size(), 1);
    std::vector<Wander> wanders(tool_count, Wander(model_to_touch(), touch.leg_frames, random));
    std::vector<ToolState> tools(tool_count);
    std::vector<SceneChange> changes;
    for (std::uint32_t i = 0; i < touch.frames; ++i)
    {
        rig.deliver();
        for (std::size_t tool = 0; tool < tool_count; ++tool)
        {
            tools[tool].position_m = wanders[tool].next();
        }
        if (touch.scene_changes)
        {
            make_changes(i, random, changes);
        }
        const FrameInput input{tools, changes, touch.budgets, rig.now_ns()};
        allocation_counter::mark_this_thread(true);
        system_call_trap::mark_frame(true);
        rig.frame().warm_caches();
        const FrameOutput output = rig.frame().run(input, touch.mark);
        system_call_trap::mark_frame(false);
        allocation_counter::mark_this_thread(false);
        add_work(watched.work, output.work);
    }
    watched.heap_calls = heap_calls();
    watched.system_calls = system_call_trap::of_this_thread().in_frame;
}

/// Watches on a separate thread, since a trap is permanent.
Watched watch(const Touch& touch)
{
    const std::uint64_t seed = seed_of(1);
    std::printf("TACTUS_SEED=%llu\n", static_cast<unsigned long long>(seed));
    Random random = Random::seeded(seed);
    FrameRig rig(model_to_touch(), touch.options);
    Watched watched;
    std::thread thread(
        [&]
        {
            if (const auto set = system_call_trap::set_on_this_thread(); !set)
            {
                watched.not_trapped = set.error().text;
            }
            watch_frames(rig, touch, random, watched);
        });
    thread.join();
    return watched;
}

void expect_clean(const Watched& watched)
{
    EXPECT_EQ(watched.heap_calls, 0U);
    EXPECT_EQ(watched.system_calls, 0U);
    EXPECT_GT(watched.work.splits, 100U) << "the frames had next to nothing to do";
    EXPECT_GT(watched.work.pages_adopted, 50U);
    if (!watched.not_trapped.empty())
    {
        GTEST_SKIP() << watched.not_trapped;
    }
}

TEST(FrameRealtime, neither_allocates_nor_calls_the_system_while_it_streams)
{
    expect_clean(watch({}));
}

TEST(FrameRealtime, nor_while_pools_are_full_and_pages_go)
{
    Touch touch;
    touch.options.pool_bytes = std::size_t{700} << 10U;
    touch.options.cache_bytes = std::size_t{300} << 10U;
    touch.leg_frames = 100;
    const Watched watched = watch(touch);
    EXPECT_GT(watched.work.evictions, 0U);
    expect_clean(watched);
}

TEST(FrameRealtime, nor_with_all_tools_and_the_largest_budgets)
{
    const double radius_m = 0.01 * model_to_touch().diagonal_m;
    Touch touch;
    touch.options.tools.assign(kMaxTools, ToolSpec{radius_m, 500.0, 8.0, 1.0});
    touch.budgets.splits = kMaxSplitsPerFrame;
    touch.budgets.merges = kMaxMergesPerFrame;
    touch.leg_frames = 100;
    touch.frames = 500;
    expect_clean(watch(touch));
}

TEST(FrameRealtime, nor_while_objects_and_tools_come_and_go_and_changes_are_refused)
{
    Touch touch;
    touch.options.tools.assign(3, ToolSpec{0.01 * model_to_touch().diagonal_m});
    touch.options.capacities.objects = 10;
    touch.scene_changes = true;
    touch.leg_frames = 100;
    expect_clean(watch(touch));
}

TEST(FrameRealtime, nor_over_a_link_that_loses_and_damages)
{
    Touch touch;
    touch.options.faults.loss = 0.2;
    touch.options.faults.damage = 0.1;
    touch.options.faults.delay_polls_max = 40;
    touch.leg_frames = 100;
    expect_clean(watch(touch));
}

// A hook runs inside the frame, so its faults are the frame's and must be detected. These two are
// not trusted: their violations are detected when they run.
TACTUS_TRUSTED_BEGIN
void allocate(void* /*context*/, Stage /*stage*/) noexcept TACTUS_NONBLOCKING
{
    // NOLINTBEGIN(cppcoreguidelines-no-malloc,cppcoreguidelines-owning-memory): to be seen.
    void* block = std::malloc(16);
    // The access keeps the compiler from removing both calls.
    *static_cast<volatile char*>(block) = 1;
    std::free(block);
    // NOLINTEND(cppcoreguidelines-no-malloc,cppcoreguidelines-owning-memory)
}

void call_the_system(void* /*context*/, Stage /*stage*/) noexcept TACTUS_NONBLOCKING
{
    static_cast<void>(getppid());
}
TACTUS_TRUSTED_END

Touch with_hook(StageMark::Function hook)
{
    Touch touch;
    touch.mark = {hook, nullptr};
    touch.frames = 10;
    return touch;
}

TEST(FrameRealtime, is_seen_to_allocate_when_its_hook_does)
{
    const Touch touch = with_hook(&allocate);
    if (kHasRealtimeSanitizer)
    {
        EXPECT_DEATH(static_cast<void>(watch(touch)), "malloc");
    }
    else if (allocation_counter::available())
    {
        EXPECT_EQ(watch(touch).heap_calls, 10U * kStages * 2U);
    }
    else
    {
        GTEST_SKIP() << "no allocation counter under this sanitizer";
    }
}

TEST(FrameRealtime, is_seen_to_call_the_system_when_its_hook_does)
{
    const Watched watched = watch(with_hook(&call_the_system));
    if (!watched.not_trapped.empty())
    {
        GTEST_SKIP() << watched.not_trapped;
    }
    EXPECT_EQ(watched.system_calls, 10U * kStages);
}

} // namespace
} // namespace tactus::test
