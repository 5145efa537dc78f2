// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/linux_extras.hpp"
#include "platform/machine/posix/posix_error.hpp"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

/// Extras for any POSIX system with /dev/urandom. Extras that need Linux do nothing, or fail like
/// those of Linux when they are refused.
namespace tactus::linux_extras
{

int pin_calling_thread(int /*cpu*/) noexcept
{
    return ENOTSUP;
}

void keep_calling_thread_off(int /*cpu*/) noexcept {}

void let_calling_thread_use_all() noexcept {}

std::string explain_pin_refusal(int cpu)
{
    return "processor " + std::to_string(cpu) +
           " can't be chosen: this build can't pin threads on this system; leave the choice to the "
           "system";
}

std::optional<int> another_cpu(int /*cpu*/) noexcept
{
    return std::nullopt;
}

std::string explain_fifo_refusal(int priority, int error)
{
    return "SCHED_FIFO " + std::to_string(priority) + " refused (" + posix::name_of_error(error) +
           "): " + posix::user_name() + " lacks the right to real-time priorities";
}

int try_to_exceed_lock_limit() noexcept
{
    return 0;
}

std::string explain_lock_refusal(int error)
{
    return "mlockall refused (" + posix::name_of_error(error) + "): " + posix::user_name() +
           " lacks the right to lock memory, or there is not enough memory";
}

void read_fault_and_switch_counts(ThreadUsage& /*usage*/) noexcept {}

void ask_for_huge_pages(std::span<std::byte> /*memory*/) noexcept {}

bool draw_random(std::span<std::byte> bytes) noexcept
{
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library has no other.
    const int file = open("/dev/urandom", O_RDONLY | O_CLOEXEC);
    if (file < 0)
    {
        return false;
    }
    const ssize_t drawn = read(file, bytes.data(), bytes.size());
    close(file);
    return drawn == static_cast<ssize_t>(bytes.size());
}

AwakeProcessors::AwakeProcessors() noexcept = default;
AwakeProcessors::~AwakeProcessors() = default;

} // namespace tactus::linux_extras
