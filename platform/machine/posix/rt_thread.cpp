// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/rt_thread.hpp"

#include "platform/machine/float_control.hpp"
#include "platform/machine/posix/linux_extras.hpp"
#include "platform/machine/posix/memory_lock.hpp"
#include "platform/machine/posix/posix_error.hpp"
#include "transport/base/refusal.hpp"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <span>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>

namespace tactus
{

namespace
{

/// Memory for one thread's stack, every page touched. A page without access below it lets an
/// overflow stop the process instead of writing elsewhere.
class ThreadStack
{
public:
    /// Rounds up to whole pages. If the system has no memory left, memory() is empty: check it.
    explicit ThreadStack(std::size_t bytes) noexcept;
    ThreadStack(const ThreadStack&) = delete;
    ThreadStack& operator=(const ThreadStack&) = delete;
    ~ThreadStack();

    [[nodiscard]] std::span<std::byte> memory() const noexcept { return memory_; }

private:
    std::span<std::byte> mapped_;
    std::span<std::byte> memory_;
};

ThreadStack::ThreadStack(std::size_t bytes) noexcept
{
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t usable = (bytes + page - 1) / page * page;
    void* start =
        mmap(nullptr, usable + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED)
    {
        return;
    }
    mapped_ = {static_cast<std::byte*>(start), usable + page};
    if (mprotect(start, page, PROT_NONE) != 0)
    {
        return;
    }
    memory_ = mapped_.subspan(page);
    std::memset(memory_.data(), 0, memory_.size());
}

ThreadStack::~ThreadStack()
{
    if (!mapped_.empty())
    {
        // munmap() of a whole mapping can't fail.
        static_cast<void>(munmap(mapped_.data(), mapped_.size()));
    }
}

/// Owns a pthread_attr_t. Its calls fail only for arguments that were checked before.
class ThreadAttributes
{
public:
    ThreadAttributes() noexcept { check(pthread_attr_init(&attributes_)); }
    ThreadAttributes(const ThreadAttributes&) = delete;
    ThreadAttributes& operator=(const ThreadAttributes&) = delete;
    ~ThreadAttributes() { check(pthread_attr_destroy(&attributes_)); }

    void use_stack(std::span<std::byte> memory) noexcept
    {
        check(pthread_attr_setstack(&attributes_, memory.data(), memory.size()));
    }

    /// The policy is explicit, so that it is not inherited from the starter.
    void use_policy(int policy, int priority) noexcept
    {
        sched_param parameter{};
        parameter.sched_priority = priority;
        check(pthread_attr_setinheritsched(&attributes_, PTHREAD_EXPLICIT_SCHED));
        check(pthread_attr_setschedpolicy(&attributes_, policy));
        check(pthread_attr_setschedparam(&attributes_, &parameter));
    }

    [[nodiscard]] const pthread_attr_t* get() const noexcept { return &attributes_; }

private:
    static void check(int error) noexcept { TACTUS_ASSERT(error == 0); }

    pthread_attr_t attributes_{};
};

/// A gate at which one thread waits until another opens it, once. Uses POSIX alone, since the C++
/// library implements semaphores differently on each system.
class Gate
{
public:
    Gate() noexcept { TACTUS_ASSERT(sem_init(&semaphore_, 0, 0) == 0); }
    Gate(const Gate&) = delete;
    Gate& operator=(const Gate&) = delete;
    ~Gate() { TACTUS_ASSERT(sem_destroy(&semaphore_) == 0); }

    void open() noexcept { TACTUS_ASSERT(sem_post(&semaphore_) == 0); }
    void wait() noexcept
    {
        while (sem_wait(&semaphore_) != 0)
        {
            TACTUS_ASSERT(errno == EINTR);
        }
    }

private:
    sem_t semaphore_{};
};

/// While an object lives, new threads start with every signal blocked.
class SignalsBlocked
{
public:
    SignalsBlocked() noexcept
    {
        sigset_t all;
        TACTUS_ASSERT(sigfillset(&all) == 0);
        TACTUS_ASSERT(pthread_sigmask(SIG_SETMASK, &all, &before_) == 0);
    }
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;
    ~SignalsBlocked() { TACTUS_ASSERT(pthread_sigmask(SIG_SETMASK, &before_, nullptr) == 0); }

private:
    sigset_t before_{};
};

/// Fault of the options; empty if all values are in range.
std::string find_bad_option(const RtThreadOptions& options)
{
    using Options = RtThreadOptions;
    const int highest = Options::kPriorityMax + (options.is_supervisor ? 1 : 0);
    if (options.priority < Options::kPriorityMin || options.priority > highest)
    {
        return "real-time priority " + std::to_string(options.priority) +
               " is out of range 1..98 (99 is kept for the supervisor)";
    }
    if (options.stack_bytes < Options::kStackBytesMin ||
        options.stack_bytes > Options::kStackBytesMax)
    {
        return "thread stack of " + std::to_string(options.stack_bytes) +
               " bytes is out of range 65536..67108864 bytes";
    }
    return {};
}

Refusal join_lines(const std::vector<std::string>& lines)
{
    std::string text;
    for (const std::string& line : lines)
    {
        text += (text.empty() ? "" : "\n") + line;
    }
    return {std::move(text)};
}

} // namespace

/// State shared by starter and thread. The thread writes its results and then waits for the
/// starter's decision; the two gates order their accesses.
struct RtThread::Running
{
    Running(const RtThreadOptions& wanted, std::function<void()> work)
        : options(wanted), body(std::move(work)), stack(wanted.stack_bytes)
    {
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running();

    static void* enter(void* context) noexcept;
    void lock_memory();
    [[nodiscard]] int create_thread();
    [[nodiscard]] int create_with(int policy, int priority) noexcept;
    void decide(bool run) noexcept;
    void join() noexcept;

    RtThreadOptions options;
    std::function<void()> body;
    ThreadStack stack;
    pthread_t thread{};
    bool joinable{false};
    RtThreadReport report;
    std::optional<linux_extras::AwakeProcessors> awake;
    int pin_error{0};
    bool undecided{false};
    bool body_may_run{false};
    Gate set_up;
    Gate decision;
};

/// Ends a thread that start() refused while it waited, and undoes the memory lock made for it.
RtThread::Running::~Running()
{
    const bool refused = undecided;
    if (refused)
    {
        decide(false);
    }
    join();
    if (refused && report.memory_locked)
    {
        posix::unlock_all_memory();
    }
}

/// First function of the new thread.
void* RtThread::Running::enter(void* context) noexcept
{
    auto& self = *static_cast<Running*>(context);
    self.report.float_control_was_default = reset_float_control();
    self.pin_error = self.options.cpu ? linux_extras::pin_calling_thread(*self.options.cpu) : 0;
    self.report.pinned = self.options.cpu && self.pin_error == 0;
    self.set_up.open();
    self.decision.wait();
    if (self.body_may_run)
    {
        self.body();
    }
    return nullptr;
}

void RtThread::Running::lock_memory()
{
    std::optional<std::string> refusal = posix::lock_all_memory();
    report.memory_locked = !refusal;
    if (refusal)
    {
        report.refused.push_back(std::move(*refusal));
    }
}

/// If SCHED_FIFO is refused the thread starts without it, so that all other refusals are found too.
/// Returns 0 or the errno.
int RtThread::Running::create_thread()
{
    int error = options.is_realtime ? create_with(SCHED_FIFO, options.priority) : EPERM;
    report.fifo = error == 0;
    if (error == EPERM && options.is_realtime)
    {
        report.refused.push_back(linux_extras::explain_fifo_refusal(options.priority, error));
    }
    if (error == EPERM)
    {
        // The priority is 0 on Linux.
        error = create_with(SCHED_OTHER, sched_get_priority_min(SCHED_OTHER));
    }
    if (error == 0)
    {
        joinable = true;
        undecided = true;
        set_up.wait();
    }
    return error;
}

int RtThread::Running::create_with(int policy, int priority) noexcept
{
    ThreadAttributes attributes;
    attributes.use_stack(stack.memory());
    attributes.use_policy(policy, priority);
    const SignalsBlocked blocked;
    return pthread_create(&thread, attributes.get(), &Running::enter, this);
}

void RtThread::Running::decide(bool run) noexcept
{
    body_may_run = run;
    undecided = false;
    decision.open();
}

void RtThread::Running::join() noexcept
{
    if (joinable)
    {
        TACTUS_ASSERT(pthread_join(thread, nullptr) == 0);
        joinable = false;
        awake.reset();
    }
}

Result<RtThread, Refusal> RtThread::start(const RtThreadOptions& options,
                                          std::function<void()> body)
{
    if (std::string wrong = find_bad_option(options); !wrong.empty())
    {
        return Refusal{.text = std::move(wrong), .is_usage = true};
    }
    auto running = std::make_unique<Running>(options, std::move(body));
    if (running->stack.memory().empty())
    {
        return Refusal{"no memory for a thread stack of " + std::to_string(options.stack_bytes) +
                       " bytes"};
    }
    if (const int error = running->create_thread(); error != 0)
    {
        return Refusal{"the system refused to start a thread (" + posix::name_of_error(error) +
                       ")"};
    }
    if (running->pin_error != 0)
    {
        return Refusal{.text = linux_extras::explain_pin_refusal(*options.cpu), .is_usage = true};
    }
    if (options.lock_memory)
    {
        running->lock_memory();
    }
    if (!running->report.refused.empty() && !options.allow_no_rt)
    {
        return join_lines(running->report.refused);
    }
    if (options.processors_awake)
    {
        running->report.processors_awake = running->awake.emplace().are_granted();
    }
    running->decide(true);
    return RtThread(std::move(running));
}

RtThread::RtThread(std::unique_ptr<Running> running) noexcept : running_(std::move(running)) {}
RtThread::RtThread(RtThread&&) noexcept = default;
RtThread& RtThread::operator=(RtThread&&) noexcept = default;
RtThread::~RtThread() = default;

void RtThread::join() noexcept
{
    running_->join();
}

const RtThreadReport& RtThread::report() const noexcept
{
    return running_->report;
}

Result<std::vector<std::string>, Refusal> probe_realtime(const RtThreadOptions& options)
{
    RtThreadOptions tried = options;
    tried.allow_no_rt = true;
    tried.processors_awake = false;
    Result<RtThread, Refusal> started = RtThread::start(tried, [] {});
    if (!started)
    {
        return started.error();
    }
    started.value().join();
    RtThreadReport report = started.value().report();
    if (report.memory_locked)
    {
        posix::unlock_all_memory();
    }
    return std::move(report).refused;
}

} // namespace tactus
