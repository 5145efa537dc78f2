// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/atomic_file.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::size_t kLongestPath = 4096; ///< With its end mark; Linux and QNX take no longer.

/// A temporary's name where a signal handler may read it.
struct PendingSlot
{
    enum State : int
    {
        unused,
        reserved, ///< Taken, the name is not complete yet.
        pending,
    };

    std::atomic<int> state{unused};
    std::array<char, kLongestPath> path{};
};

static_assert(std::atomic<int>::is_always_lock_free, "the signal handler reads it");

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

std::array<PendingSlot, AtomicFile::kMaxPending>& pending_slots()
{
    static constinit std::array<PendingSlot, AtomicFile::kMaxPending> slots;
    return slots;
}

/// Keeps the signals away from this thread between making a temporary and registering its name.
class SignalPause
{
public:
    SignalPause()
    {
        sigset_t blocked;
        sigemptyset(&blocked);
        for (const int signal : kSignals)
        {
            sigaddset(&blocked, signal);
        }
        pthread_sigmask(SIG_BLOCK, &blocked, &before_);
    }
    ~SignalPause() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalPause(const SignalPause&) = delete;
    SignalPause& operator=(const SignalPause&) = delete;

private:
    sigset_t before_{};
};

/// kMaxPending when all are taken.
std::size_t reserve_slot()
{
    for (std::size_t i = 0; i < pending_slots().size(); ++i)
    {
        int expected = PendingSlot::unused;
        if (pending_slots()[i].state.compare_exchange_strong(expected, PendingSlot::reserved))
        {
            return i;
        }
    }
    return AtomicFile::kMaxPending;
}

void release_slot(std::size_t slot)
{
    pending_slots()[slot].state = PendingSlot::unused;
}

void remove_pending_and_reraise(int signal)
{
    for (const PendingSlot& slot : pending_slots())
    {
        if (slot.state == PendingSlot::pending)
        {
            ::unlink(slot.path.data());
        }
    }
    std::raise(signal); // SA_RESETHAND has put the default action back.
}

FileError error_for(const std::filesystem::path& path, std::string_view what, int code)
{
    return {fmt::format("{}: {}: {}", path.string(), what, std::strerror(code))};
}

/// Makes a new file beside `target` and leaves its name in `name`; -1 and errno when it can't.
int make_temporary(const std::filesystem::path& target, std::string& name)
{
    constexpr int kTries = 1000; // Names left over by killed processes with our id.
    for (int i = 0; i < kTries; ++i)
    {
        name = (target.parent_path() /
                fmt::format(".{}.{}-{}.tmp", target.filename().string(), ::getpid(), i))
                   .string();
        if (name.size() >= kLongestPath)
        {
            errno = ENAMETOOLONG;
            return -1;
        }
        const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0 || errno != EEXIST)
        {
            return descriptor;
        }
    }
    return -1;
}

/// Makes a rename durable. Not every file system can; the file itself is synced by then.
void sync_directory(const std::filesystem::path& directory)
{
    const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0)
    {
        ::fsync(descriptor);
        ::close(descriptor);
    }
}

} // namespace

Result<AtomicFile, FileError> AtomicFile::create(const std::filesystem::path& path)
{
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    {
        return FileError{path.string() + ": is not a regular file and can't be replaced"};
    }
    const auto target = std::filesystem::absolute(path, code);
    if (code || !path.has_filename())
    {
        return FileError{fmt::format("'{}': is not a file name", path.string())};
    }
    const std::size_t slot = reserve_slot();
    if (slot == kMaxPending)
    {
        return FileError{fmt::format("{}: more than {} files are being written at once",
                                     path.string(), kMaxPending)};
    }
    auto& pending = pending_slots()[slot];
    const SignalPause pause;
    std::string name;
    const int descriptor = make_temporary(target, name);
    if (descriptor < 0)
    {
        const int reason = errno;
        release_slot(slot);
        return error_for(path, "no file can be made in its directory", reason);
    }
    std::memcpy(pending.path.data(), name.c_str(), name.size() + 1);
    pending.state = PendingSlot::pending;
    return AtomicFile(target, name, descriptor, slot);
}

void AtomicFile::remove_pending_on_signal()
{
    for (const int signal : kSignals)
    {
        struct sigaction action
        {
        };
        if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN)
        {
            continue;
        }
        action = {};
        action.sa_handler = remove_pending_and_reraise;
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigfillset(&action.sa_mask);
        ::sigaction(signal, &action, nullptr);
    }
}

AtomicFile::AtomicFile(std::filesystem::path path, std::filesystem::path temporary, int descriptor,
                       std::size_t slot)
    : path_(std::move(path)), temporary_(std::move(temporary)), descriptor_(descriptor), slot_(slot)
{
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_))
    , temporary_(std::move(other.temporary_))
    , descriptor_(std::exchange(other.descriptor_, -1))
    , slot_(other.slot_)
    , end_(other.end_)
{
}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept
{
    if (this != &other)
    {
        discard();
        path_ = std::move(other.path_);
        temporary_ = std::move(other.temporary_);
        descriptor_ = std::exchange(other.descriptor_, -1);
        slot_ = other.slot_;
        end_ = other.end_;
    }
    return *this;
}

AtomicFile::~AtomicFile()
{
    discard();
}

Result<Done, FileError> AtomicFile::write(std::span<const std::byte> bytes)
{
    auto done = write_at(end_, bytes);
    end_ += done ? bytes.size() : 0;
    return done;
}

Result<Done, FileError> AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes)
{
    TACTUS_ASSERT(descriptor_ >= 0);
    while (!bytes.empty())
    {
        const ssize_t written =
            ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR)
        {
            continue;
        }
        if (written <= 0)
        {
            errno = written == 0 ? ENOSPC : errno;
            return error("can't be written");
        }
        offset += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return Done{};
}

Result<Done, FileError> AtomicFile::commit()
{
    TACTUS_ASSERT(descriptor_ >= 0);
    if (::fsync(descriptor_) != 0)
    {
        const FileError reason = error("can't be flushed to the disk");
        discard();
        return reason;
    }
    const SignalPause pause;
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0)
    {
        const FileError reason = error("can't be renamed to");
        discard();
        return reason;
    }
    release_slot(slot_);
    ::close(std::exchange(descriptor_, -1)); // Synced: close has nothing left to report.
    sync_directory(path_.parent_path());
    return Done{};
}

void AtomicFile::discard() noexcept
{
    if (descriptor_ >= 0)
    {
        ::close(std::exchange(descriptor_, -1));
        ::unlink(temporary_.c_str());
        release_slot(slot_);
    }
}

FileError AtomicFile::error(const char* what) const
{
    return error_for(path_, what, errno);
}

} // namespace tactus
