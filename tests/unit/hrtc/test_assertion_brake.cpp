// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/controller.hpp"
#include "platform/controller/finished_run.hpp"
#include "platform/controller/session.hpp"
#include "platform/devices/wrapped_device.hpp"
#include "platform/hrtc/subcommands.hpp"
#include "platform/loop/assertion_brake.hpp"
#include "platform/loop/tool_port.hpp"
#include "platform/program/run_program.hpp"
#include "platform/recording/recording.hpp"
#include "platform/recording/replay.hpp"
#include "rt_core/base/assert.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <optional>
#include <poll.h>
#include <string>
#include <string_view>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

/// Complete sessions, each in its own process, in which an assertion fails on one of the threads.
namespace tactus::hrtc::test
{
namespace
{

constexpr int kExitCode = 2;
constexpr std::uint64_t kFailAt = 200; ///< Reading in which the bug occurs.
constexpr std::uint64_t kFadeWrites = 51;
constexpr std::uint64_t kFadeFailsAt = 7;
/// Time limit, which only ends a test that would wait endlessly for a missing brake.
constexpr std::chrono::milliseconds kHopeless{120'000};
constexpr bool kThereIsNoBug = false;
constexpr bool kThereIsNoSecondBug = false;

/// Place of the bug.
enum class Bug : std::uint8_t
{
    none,
    haptic,
    haptic_and_fade, ///< A second bug occurs while the forces fade.
    frame,           ///< Bug on the haptic thread, by the frame's input.
    main,
    supervisor,
    other,
};

/// Message from the device to the test through a pipe.
struct Event
{
    enum class Kind : std::uint8_t
    {
        brake,
        release,
    };
    Kind kind{Kind::brake};
    bool is_after_bug{false};
    bool is_haptic_thread{false};
    bool is_braked{false};
    std::uint64_t writes_since_bug{0};
    int stderr_bytes{0};        ///< Bytes waiting for a reader now.
    int stderr_bytes_at_bug{0}; ///< Bytes waiting when the bug occurred.
};

int bytes_in(int pipe)
{
    int bytes = 0;
    return ioctl(pipe, FIONREAD, &bytes) == 0 ? bytes : -1;
}

/// Fills the pipe to the last byte.
void fill(int pipe)
{
    const int flags = fcntl(pipe, F_GETFL);
    fcntl(pipe, F_SETFL, flags | O_NONBLOCK); // NOLINT(hicpp-signed-bitwise): the C interface's.
    const std::vector<char> dots(65'536, '.');
    while (write(pipe, dots.data(), dots.size()) > 0)
    {
    }
    while (write(pipe, dots.data(), 1) == 1)
    {
    }
    fcntl(pipe, F_SETFL, flags);
}

struct Plan
{
    Bug bug{Bug::none};
    bool stderr_is_full{false};
    bool main_hangs{false}; ///< True if the main thread never ends the process.
    std::string record_path{};
    std::string folder{};    ///< Folder of the run; empty: a temporary one.
    std::string recording{}; ///< Recording whose hand the device replays, unless empty.
};

/// Kernels of which one fails as soon as a proxy has reached a surface, depending only on the
/// frame's input.
const Kernels& failing_kernels()
{
    static const Kernels failing = []
    {
        Kernels kernels = portable_kernels();
        kernels.planes_below =
            [](const PlaneTable& table, const PlaneQuestion& question, PlaneHit* hits) noexcept
        {
            const PlaneCounts counts = portable_kernels().planes_below(table, question, hits);
            const bool is_far_from_surfaces = counts.hits == 0;
            TACTUS_ASSERT(is_far_from_surfaces);
            return counts;
        };
        return kernels;
    }();
    return failing;
}

/// Device of the child process: triggers the bug, and reports brakes and releases.
struct FailingDevice final : WrappedDevice
{
    FailingDevice(std::unique_ptr<HapticDevice> device, Plan plan, int events)
        : WrappedDevice(std::move(device))
        , plan_(std::move(plan))
        , events_(events)
        , main_(pthread_self())
        , other_([this] { fail_elsewhere(); })
    {
        other_.detach();
    }

    [[nodiscard]] DeviceSample read() noexcept override
    {
        haptic_.store(std::this_thread::get_id());
        ++reads_;
        if (reads_ == kFailAt - 1)
        {
            prepare();
        }
        if (reads_ == kFailAt)
        {
            start_bug();
        }
        if (reads_ > kFailAt && plan_.bug == Bug::supervisor)
        {
            wait_for_supervisor();
        }
        return WrappedDevice::read();
    }
    void write(const Wrench& wrench) noexcept override
    {
        WrappedDevice::write(wrench);
        writes_since_bug_ += has_bug_.load() ? 1 : 0;
        if (plan_.bug == Bug::haptic_and_fade && writes_since_bug_ == kFadeFailsAt)
        {
            TACTUS_ASSERT(kThereIsNoSecondBug);
        }
    }
    void brake() noexcept override
    {
        if (plan_.bug == Bug::supervisor && has_bug_.load() && !supervisor_failed_.exchange(true))
        {
            TACTUS_ASSERT(kThereIsNoBug); // The handler brakes again.
        }
        WrappedDevice::brake();
        tell(Event::Kind::brake);
    }
    void release_brake() noexcept override
    {
        WrappedDevice::release_brake();
        tell(Event::Kind::release);
    }

private:
    void prepare() noexcept
    {
        if (plan_.stderr_is_full)
        {
            fill(STDERR_FILENO);
        }
        stderr_bytes_at_bug_ = bytes_in(STDERR_FILENO);
    }

    void start_bug() noexcept
    {
        if (plan_.main_hangs)
        {
            pthread_kill(main_, SIGUSR2);
        }
        has_bug_.store(true);
        has_bug_.notify_all();
        switch (plan_.bug)
        {
        case Bug::haptic:
        case Bug::haptic_and_fade:
            TACTUS_ASSERT(kThereIsNoBug);
            break;
        case Bug::main:
            pthread_kill(main_, SIGUSR1);
            break;
        case Bug::none:
        case Bug::frame:
        case Bug::supervisor:
        case Bug::other:
            break;
        }
    }

    /// Waits for the supervisor's failure, in a later frame than the bug's: it may have braked
    /// already in that one, and brakes once a silence.
    void wait_for_supervisor() const noexcept
    {
        while (!supervisor_failed_.load())
        {
        }
    }

    void fail_elsewhere() noexcept
    {
        has_bug_.wait(false);
        if (plan_.bug == Bug::other)
        {
            TACTUS_ASSERT(kThereIsNoBug);
        }
    }

    void tell(Event::Kind kind) noexcept
    {
        const Event event{kind,
                          has_bug_.load(),
                          haptic_.load() == std::this_thread::get_id(),
                          WrappedDevice::status().state == DeviceState::brake,
                          writes_since_bug_.load(),
                          bytes_in(STDERR_FILENO),
                          stderr_bytes_at_bug_};
        static_cast<void>(::write(events_, &event, sizeof(event)) == sizeof(event));
    }

    Plan plan_;
    int events_;
    pthread_t main_;
    std::atomic<std::thread::id> haptic_{};
    std::uint64_t reads_{0};
    std::atomic<std::uint64_t> writes_since_bug_{0};
    std::atomic<bool> has_bug_{false};
    std::atomic<bool> supervisor_failed_{false};
    int stderr_bytes_at_bug_{0};
    std::thread other_; ///< Last member, since it uses the others.
};

/// Main thread of the child. Returns if the bug did not end it.
void run_session(const Plan& plan, const std::string& model, int events)
{
    std::signal(SIGUSR1, [](int) { TACTUS_ASSERT(kThereIsNoBug); });
    std::signal(SIGUSR2,
                [](int)
                {
                    for (;;)
                    {
                        pause();
                    }
                });
    install_assertion_brake();
    std::filesystem::current_path(plan.folder);
    Options options;
    options.kernels = plan.bug == Bug::frame ? &failing_kernels() : nullptr;
    if (!plan.recording.empty())
    {
        options.tools[0].device.kind = DeviceKind::replay;
        options.tools[0].device.recording = plan.recording;
    }
    options.transport = TransportKind::file;
    options.models = {model};
    options.objects.resize(1);
    options.pool_mib = 8.0;
    options.duration_s = 3'600.0;
    options.record_path = plan.record_path;
    options.thread.allow_no_rt = true;
    auto session = Session::open(options);
    if (!session)
    {
        leave_with(session.error());
        return;
    }
    ToolSetup& tool = session.value()->controller().tools().front();
    tool.device = std::make_unique<FailingDevice>(std::move(tool.device), plan, events);
    if (const auto done = session.value()->run("touch"); !done)
    {
        leave_with(done.error());
    }
}

struct Pipe
{
    Pipe() { TACTUS_ASSERT(pipe(ends_.data()) == 0); }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe()
    {
        close(ends_[0]);
        close_writer();
    }
    [[nodiscard]] int reader() const { return ends_[0]; }
    [[nodiscard]] int writer() const { return ends_[1]; }
    void close_writer() { close(std::exchange(ends_[1], -1)); }

private:
    std::array<int, 2> ends_{};
};

/// End of the child process, with its earlier output.
struct Ended
{
    int code{-1};
    std::string text; ///< Output on stderr, without the filling.
    std::vector<Event> events;

    /// Brake on that thread after the bug; null if there was none.
    [[nodiscard]] const Event* brake(bool on_haptic_thread) const
    {
        const auto found =
            std::ranges::find_if(events,
                                 [&](const Event& event)
                                 {
                                     return event.kind == Event::Kind::brake &&
                                            event.is_after_bug &&
                                            event.is_haptic_thread == on_haptic_thread;
                                 });
        return found == events.end() ? nullptr : &*found;
    }
};

/// Reads until the expected brake, or to the end.
void read_events(int pipe, Ended& ended, std::optional<bool> until_brake_on_haptic_thread)
{
    pollfd in{pipe, POLLIN, 0};
    Event event;
    const auto is_there = [&]
    { return until_brake_on_haptic_thread && ended.brake(*until_brake_on_haptic_thread); };
    while (!is_there() && poll(&in, 1, static_cast<int>(kHopeless.count())) == 1 &&
           read(pipe, &event, sizeof(event)) == sizeof(event))
    {
        ended.events.push_back(event);
    }
}

std::string read_to_end(int pipe)
{
    std::string text;
    std::array<char, 4'096> part{};
    for (ssize_t bytes = 0; (bytes = read(pipe, part.data(), part.size())) > 0;)
    {
        text.append(part.data(), static_cast<std::size_t>(bytes));
    }
    return text;
}

/// Runs the child; its stderr is not read before the brake that its bug causes.
Ended run_in_child(Plan plan)
{
    const tactus::test::TemporaryFolder own("failed-run");
    plan.folder = plan.folder.empty() ? own.path().string() : plan.folder;
    const std::string model = tactus::test::small_model(0).path;
    Pipe errors;
    Pipe events;
    const pid_t child = fork();
    if (child == 0)
    {
        dup2(errors.writer(), STDERR_FILENO);
        run_session(plan, model, events.writer());
        std::_Exit(0);
    }
    errors.close_writer();
    events.close_writer();
    Ended ended;
    read_events(events.reader(), ended,
                plan.bug == Bug::haptic || plan.bug == Bug::haptic_and_fade);
    ended.text = read_to_end(errors.reader());
    ended.text.erase(0, ended.text.find_first_not_of('.'));
    while (ended.text.starts_with("touch: ")) // A slow machine may print this first.
    {
        ended.text.erase(0, ended.text.find('\n') + 1);
    }
    read_events(events.reader(), ended, std::nullopt);
    int status = 0;
    TACTUS_ASSERT(waitpid(child, &status, 0) == child);
    ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return ended;
}

constexpr std::string_view kLine = "hrtc: internal error: kThereIsNoBug (";
constexpr std::string_view kFrameLine = "hrtc: internal error: is_far_from_surfaces (";
constexpr std::string_view kSecondLine = "hrtc: internal error: kThereIsNoSecondBug (";

void expect_nothing_printed(const Event& brake)
{
    EXPECT_EQ(brake.stderr_bytes, brake.stderr_bytes_at_bug);
}

TEST(AssertionBrake, on_the_haptic_thread_the_forces_fade_before_anything_is_printed)
{
    for (const bool is_full : {false, true})
    {
        const Ended ended = run_in_child({.bug = Bug::haptic, .stderr_is_full = is_full});
        const Event* brake = ended.brake(true);
        ASSERT_NE(brake, nullptr) << is_full;
        EXPECT_EQ(brake->writes_since_bug, kFadeWrites) << is_full;
        EXPECT_EQ(brake->stderr_bytes_at_bug > 0, is_full);
        EXPECT_TRUE(brake->is_braked) << is_full;
        expect_nothing_printed(*brake);
        EXPECT_TRUE(ended.text.starts_with(kLine)) << ended.text;
        EXPECT_EQ(ended.code, kExitCode) << is_full;
    }
}

TEST(AssertionBrake, the_recording_is_kept_up_to_the_frame_that_failed)
{
    const std::string path = testing::TempDir() + "failed_run.tactusrec";
    std::filesystem::remove(path); // The file may be that of an earlier run.
    const Ended ended = run_in_child({.bug = Bug::haptic, .record_path = path});
    EXPECT_EQ(ended.code, kExitCode);
    const auto recording = Recording::read(path);
    ASSERT_TRUE(recording) << recording.error().text;
    EXPECT_EQ(recording.value().frame_count(), kFailAt - 1);
}

Recording read_recording(const std::string& path)
{
    auto recording = Recording::read(path);
    TACTUS_ASSERT(recording);
    return std::move(recording).value();
}

TEST(AssertionBrake, a_recorded_frame_that_failed_fails_again_in_its_replay)
{
    const std::string path = testing::TempDir() + "failed_frame.rec";
    const Ended ended = run_in_child({.bug = Bug::frame, .record_path = path});
    EXPECT_EQ(ended.code, kExitCode);
    EXPECT_TRUE(ended.text.starts_with(kFrameLine)) << ended.text;
    EXPECT_NE(ended.text.find("\nhrtc: 'hrtc --replay " + path + "' repeats the failure\n"),
              std::string::npos)
        << ended.text;

    const Recording recording = read_recording(path);
    EXPECT_TRUE(recording.has_failed());
    ASSERT_GT(recording.frame_count(), 1U);
    const auto sound = replay(recording, &portable_kernels());
    ASSERT_TRUE(sound);
    ASSERT_TRUE(sound.value().difference);
    EXPECT_EQ(sound.value().difference->frame, recording.frame_count() - 1);
    EXPECT_EQ(sound.value().difference->text, "it failed in the run, but not in the replay");
    EXPECT_FALSE(replay(recording, &failing_kernels(), {.runs_failed = false}).value().difference);
    const auto fail_again = [&]
    {
        install_assertion_brake();
        std::_Exit(replay_file(path, &failing_kernels(), {},
                               [](const std::string& line)
                               { std::fprintf(stderr, "%s\n", line.c_str()); }));
    };
    EXPECT_EXIT(fail_again(), testing::ExitedWithCode(kExitCode),
                "failed_frame.rec: frame [0-9]+, which failed in the run, runs now\nhrtc: internal "
                "error: is_far_from_surfaces \\(.*\n$");
}

TEST(AssertionBrake, without_a_recording_the_hands_last_frames_are_kept_and_fail_again)
{
    const tactus::test::TemporaryFolder kept("kept-inputs");
    const std::string folder = kept.path().string();
    const Ended ended = run_in_child({.bug = Bug::frame, .folder = folder});
    EXPECT_EQ(ended.code, kExitCode);
    EXPECT_TRUE(ended.text.starts_with(kFrameLine)) << ended.text;
    const std::size_t begin = ended.text.find("hrtc-failed-");
    ASSERT_NE(begin, std::string::npos) << ended.text;
    const std::string name = ended.text.substr(begin, ended.text.find('\'', begin) - begin);
    const Recording recording = read_recording(folder + "/" + name);
    EXPECT_FALSE(recording.keeps_run());
    EXPECT_FALSE(replay(recording)) << "the state before the first frame isn't there";

    const Ended again =
        run_in_child({.bug = Bug::frame, .folder = folder, .recording = folder + "/" + name});
    EXPECT_EQ(again.code, kExitCode);
    EXPECT_TRUE(again.text.starts_with(kFrameLine)) << again.text;
}

TEST(AssertionBrake, a_second_bug_ends_the_fade_and_both_are_printed_in_order)
{
    const Ended ended = run_in_child({.bug = Bug::haptic_and_fade, .stderr_is_full = true});
    const Event* brake = ended.brake(true);
    ASSERT_NE(brake, nullptr);
    EXPECT_EQ(brake->writes_since_bug, kFadeFailsAt);
    expect_nothing_printed(*brake);
    EXPECT_TRUE(ended.text.starts_with(kLine)) << ended.text;
    EXPECT_NE(ended.text.find(kSecondLine), std::string::npos) << ended.text;
    EXPECT_EQ(ended.code, kExitCode);
}

TEST(AssertionBrake, the_thread_that_failed_ends_the_process_when_the_main_thread_hangs)
{
    const Ended ended = run_in_child({.bug = Bug::haptic, .main_hangs = true});
    EXPECT_NE(ended.brake(true), nullptr);
    EXPECT_TRUE(ended.text.starts_with(kLine)) << ended.text;
    EXPECT_EQ(ended.code, kExitCode);
}

struct Thread
{
    const char* name;
    Bug bug;
};

using AssertionOnOrdinaryThread = testing::TestWithParam<Thread>;

INSTANTIATE_TEST_SUITE_P(Each, AssertionOnOrdinaryThread,
                         testing::Values(Thread{"main", Bug::main},
                                         Thread{"supervisor", Bug::supervisor},
                                         Thread{"other", Bug::other}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(AssertionOnOrdinaryThread, brakes_the_devices_for_good_then_prints_and_ends_the_process)
{
    for (const bool is_full : {false, true})
    {
        const Ended ended = run_in_child({.bug = GetParam().bug, .stderr_is_full = is_full});
        const Event* brake = ended.brake(false);
        ASSERT_NE(brake, nullptr) << is_full;
        EXPECT_TRUE(brake->is_braked) << is_full;
        expect_nothing_printed(*brake);
        EXPECT_EQ(ended.events.back().kind, Event::Kind::brake) << is_full;
        EXPECT_TRUE(ended.text.starts_with(kLine)) << ended.text;
        EXPECT_EQ(ended.code, kExitCode) << is_full;
    }
}

TEST(AssertionBrakeDeathTest, without_a_loop_a_failed_assertion_is_printed_and_ends_the_process)
{
    const auto fail = []
    {
        install_assertion_brake();
        TACTUS_ASSERT(kThereIsNoBug);
    };
    EXPECT_EXIT(fail(), testing::ExitedWithCode(kExitCode),
                "^hrtc: internal error: kThereIsNoBug \\(.*test_assertion_brake.cpp:[0-9]+\\)\n$");
}

} // namespace
} // namespace tactus::hrtc::test
