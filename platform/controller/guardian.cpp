// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/guardian.hpp"

#include "platform/machine/posix/linux_extras.hpp"
#include "platform/machine/posix/memory_lock.hpp"
#include "transport/base/program_log.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <pthread.h>
#include <sched.h>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tactus::hrtc
{

namespace
{

constexpr char kEnds = 'e';    ///< Message that the devices are closed and need no brake.
constexpr char kCrashes = 'c'; ///< Message that the process is about to die.
/// Answer that the guardian is ready. Other answers are kNoGuards and a refusal's text.
constexpr char kReady = 'r';
constexpr char kNoGuards = 'n';

/// Writing end of the pipe, for the report of a crash; -1: none. Loaded by a signal handler.
std::atomic<int> crash_pipe{-1};
static_assert(std::atomic<int>::is_always_lock_free);

class Pipe
{
public:
    static std::optional<Pipe> make()
    {
        std::array<int, 2> ends{};
        if (::pipe(ends.data()) != 0)
        {
            return std::nullopt;
        }
        ::fcntl(ends[0], F_SETFD, FD_CLOEXEC);
        ::fcntl(ends[1], F_SETFD, FD_CLOEXEC);
        return Pipe(ends);
    }
    Pipe(Pipe&& other) noexcept : ends_(std::exchange(other.ends_, {-1, -1})) {}
    Pipe& operator=(Pipe&&) = delete;
    ~Pipe()
    {
        close_reader();
        close_writer();
    }

    [[nodiscard]] int reader() const noexcept { return ends_[0]; }
    [[nodiscard]] int writer() const noexcept { return ends_[1]; }
    void close_reader() noexcept { close(ends_[0]); }
    void close_writer() noexcept { close(ends_[1]); }
    [[nodiscard]] int take_writer() noexcept { return std::exchange(ends_[1], -1); }

private:
    explicit Pipe(std::array<int, 2> ends) : ends_(ends) {}
    static void close(int& end) noexcept
    {
        if (end >= 0)
        {
            ::close(std::exchange(end, -1));
        }
    }

    std::array<int, 2> ends_;
};

void write_all(int descriptor, std::string_view text) noexcept
{
    while (!text.empty())
    {
        const ssize_t count = ::write(descriptor, text.data(), text.size());
        if (count < 0 && errno != EINTR)
        {
            return;
        }
        text.remove_prefix(count > 0 ? static_cast<std::size_t>(count) : 0);
    }
}

/// Reads one byte; none at the end or after an error.
std::optional<char> read_one(int descriptor) noexcept
{
    char byte = 0;
    ssize_t count = 0;
    do
    {
        count = ::read(descriptor, &byte, 1);
    } while (count < 0 && errno == EINTR);
    return count == 1 ? std::optional(byte) : std::nullopt;
}

constexpr std::array kCrashSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

/// Actions of kCrashSignals before watch_for_crashes().
std::array<struct sigaction, kCrashSignals.size()>& former_actions()
{
    static std::array<struct sigaction, kCrashSignals.size()> actions{};
    return actions;
}

void restore_crash_signals() noexcept
{
    for (std::size_t i = 0; i < kCrashSignals.size(); ++i)
    {
        ::sigaction(kCrashSignals[i], &former_actions()[i], nullptr);
    }
}

/// Signal handler: reports the crash and raises the signal again. The signal takes its former
/// action when the handler returns.
void report_crash(int signal)
{
    const int error = errno;
    [[maybe_unused]] const ssize_t written = ::write(crash_pipe.load(), &kCrashes, 1);
    restore_crash_signals();
    ::raise(signal);
    errno = error;
}

void watch_for_crashes(int pipe) noexcept
{
    crash_pipe.store(pipe);
    for (std::size_t i = 0; i < kCrashSignals.size(); ++i)
    {
        struct sigaction action = {};
        action.sa_handler = report_crash;
        ::sigaction(kCrashSignals[i], &action, &former_actions()[i]);
    }
}

// --- Code that runs in the guardian's process.

/// Detaches the guardian from the terminal and ignores the signals that end programs. Signals to
/// all processes of a service, or to all named hrtc, are meant for hrtc's own process.
void leave_company()
{
    ::setsid();
    ::pthread_setname_np(::pthread_self(), "guardian");
    for (const int signal :
         {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2})
    {
        struct sigaction action = {};
        action.sa_handler = SIG_IGN;
        ::sigaction(signal, &action, nullptr);
    }
    const int nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(nothing, STDOUT_FILENO);
    if (nothing > STDERR_FILENO)
    {
        ::close(nothing);
    }
}

/// Locks the memory and sets SCHED_FIFO. Returns the reason if that fails, else an empty text.
std::string become_realtime(int priority)
{
    if (auto refused = posix::lock_all_memory())
    {
        return *refused;
    }
    sched_param parameter{};
    parameter.sched_priority = priority;
    return ::sched_setscheduler(0, SCHED_FIFO, &parameter) == 0
               ? std::string()
               : linux_extras::explain_fifo_refusal(priority, errno);
}

bool brake_all(const Guardian::Guards& guards) noexcept
{
    bool are_braked = true;
    for (const auto& guard : guards)
    {
        are_braked = guard->brake() && are_braked;
    }
    return are_braked;
}

void watch_over(const Guardian::Guards& guards, int life)
{
    std::optional<char> word;
    while ((word = read_one(life)) == kCrashes)
    {
        static_cast<void>(brake_all(guards));
    }
    if (!word)
    {
        const bool are_braked = brake_all(guards);
        log_message(LogLevel::error, "hrtc",
                    are_braked ? "guardian: hrtc has died; its devices are braked"
                               : "guardian: hrtc has died, and a device did not brake");
    }
}

/// Body of the guardian's process: reports on `answer`, then waits on `life`. No exception may
/// leave it, because its stack is a copy of hrtc's.
void guard(const Guardian::MakeGuards& make, int priority, bool allow_no_rt, int life,
           int answer) noexcept
{
    leave_company();
    const auto guards = make();
    if (!guards)
    {
        write_all(answer, guards.error().text);
        return;
    }
    if (guards.value().empty())
    {
        write_all(answer, std::string_view(&kNoGuards, 1));
        return;
    }
    const std::string refused = become_realtime(priority);
    if (!refused.empty() && !allow_no_rt)
    {
        write_all(answer, refused);
        return;
    }
    write_all(answer, std::string_view(&kReady, 1));
    ::close(answer);
    watch_over(guards.value(), life);
}

Refusal refuse(const std::string& why)
{
    return {"the guardian can't start: " + why};
}

} // namespace

Result<std::unique_ptr<Guardian>, Refusal> Guardian::start(const MakeGuards& make, int priority,
                                                           bool allow_no_rt)
{
    auto life = Pipe::make();
    auto answer = Pipe::make();
    const pid_t process = life && answer ? ::fork() : -1;
    if (process < 0)
    {
        return refuse(std::strerror(errno));
    }
    if (process == 0)
    {
        life->close_writer();
        answer->close_reader();
        guard(make, priority, allow_no_rt, life->reader(), answer->writer());
        ::_exit(0);
    }
    answer->close_writer();
    std::unique_ptr<Guardian> guardian(new Guardian(process, life->take_writer()));
    std::string words;
    while (const auto letter = read_one(answer->reader()))
    {
        words += *letter;
    }
    if (words == std::string_view(&kReady, 1))
    {
        watch_for_crashes(guardian->life_);
        return guardian;
    }
    if (words == std::string_view(&kNoGuards, 1))
    {
        return std::unique_ptr<Guardian>();
    }
    return refuse(words.empty() ? "its process ended before it was ready" : words);
}

Guardian::~Guardian()
{
    if (crash_pipe.exchange(-1) == life_)
    {
        restore_crash_signals();
    }
    const bool is_there = !has_died();
    if (is_there)
    {
        write_all(life_, std::string_view(&kEnds, 1));
    }
    ::close(life_);
    if (is_there)
    {
        while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR)
        {
        }
    }
}

bool Guardian::has_died() noexcept
{
    has_died_ = has_died_ || ::waitpid(process_, nullptr, WNOHANG) == process_;
    return has_died_;
}

} // namespace tactus::hrtc
