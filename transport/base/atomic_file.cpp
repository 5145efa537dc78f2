// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/atomic_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace tactus
{

namespace
{

/// Maximum bytes of a path with its terminating zero, on Linux and QNX.
constexpr std::size_t kLongestPath = 4096;

/// Path of a partial file, stored where a signal handler may read it.
struct PendingSlot
{
    enum State : int
    {
        unused,
        reserved, ///< In use, but `path` is not complete.
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

/// Blocks the handled signals on this thread while a partial file is created and registered.
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

/// Reserves a free slot and returns its index; kMaxPending if none is free.
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
    std::raise(signal); // SA_RESETHAND has restored the default action.
}

Refusal refuse(const std::filesystem::path& path, const std::string& reason)
{
    return {path.string() + ": can't be written: " + reason};
}

/// True if `path` is a link that may stay while its target is replaced. A link of another user in a
/// folder like /tmp may lead anywhere; the rule is Linux's for opening files
/// (fs.protected_symlinks).
bool is_trusted_link(const std::filesystem::path& path)
{
    struct stat link
    {
    };
    struct stat folder
    {
    };
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
    if (::lstat(path.c_str(), &link) != 0 || !S_ISLNK(link.st_mode) ||
        ::stat(parent.c_str(), &folder) != 0)
    {
        return false;
    }
    constexpr mode_t kOpenToAll = S_ISVTX | S_IWOTH;
    return (folder.st_mode & kOpenToAll) != kOpenToAll || link.st_uid == ::geteuid() ||
           link.st_uid == folder.st_uid;
}

/// Creates a partial file beside `target` and sets `name` to its path. Returns the descriptor, or
/// -1 with errno set.
int make_partial(const std::filesystem::path& target, std::string& name)
{
    constexpr int kTries = 1000; // Killed processes of the same id may have left files.
    for (int i = 0; i < kTries; ++i)
    {
        name = target.string() + '.' + std::to_string(::getpid()) + '-' + std::to_string(i) +
               ".partial";
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

/// Makes a rename durable, where the file system supports that. The file itself is already synced.
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

Result<AtomicFile, Refusal> AtomicFile::create(const std::filesystem::path& path)
{
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    {
        // Replacing a device or pipe is never intended.
        return refuse(path, "the path is a directory, device or pipe");
    }
    const bool follows = std::filesystem::exists(status) && is_trusted_link(path);
    const auto target =
        follows ? std::filesystem::canonical(path, code) : std::filesystem::absolute(path, code);
    if (code || !path.has_filename())
    {
        return refuse(path, "the path has no file name");
    }
    const std::size_t slot = reserve_slot();
    if (slot == kMaxPending)
    {
        return refuse(path, "more than " + std::to_string(kMaxPending) +
                                " files are being written at once");
    }
    auto& pending = pending_slots()[slot];
    const SignalPause pause;
    std::string name;
    const int descriptor = make_partial(target, name);
    if (descriptor < 0)
    {
        const int reason = errno;
        release_slot(slot);
        return refuse(path, std::string("no file can be created in its directory: ") +
                                std::strerror(reason));
    }
    std::memcpy(pending.path.data(), name.c_str(), name.size() + 1);
    pending.state = PendingSlot::pending;
    return AtomicFile(path.string(), target, name, descriptor, slot);
}

std::optional<Refusal> AtomicFile::probe(const std::filesystem::path& path)
{
    const auto file = create(path);
    return file ? std::nullopt : std::optional(file.error());
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

AtomicFile::AtomicFile(std::string name, std::filesystem::path path, std::filesystem::path partial,
                       int descriptor, std::size_t slot)
    : name_(std::move(name))
    , path_(std::move(path))
    , partial_(std::move(partial))
    , descriptor_(descriptor)
    , slot_(slot)
{
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : name_(std::move(other.name_))
    , path_(std::move(other.path_))
    , partial_(std::move(other.partial_))
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
        name_ = std::move(other.name_);
        path_ = std::move(other.path_);
        partial_ = std::move(other.partial_);
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

Result<Done, Refusal> AtomicFile::write(std::span<const std::byte> bytes)
{
    auto done = write_at(end_, bytes);
    end_ += done ? bytes.size() : 0;
    return done;
}

Result<Done, Refusal> AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes)
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
            return error();
        }
        offset += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return Done{};
}

Result<Done, Refusal> AtomicFile::commit()
{
    TACTUS_ASSERT(descriptor_ >= 0);
    if (::fsync(descriptor_) != 0)
    {
        const Refusal reason = error();
        discard();
        return reason;
    }
    const SignalPause pause;
    if (std::rename(partial_.c_str(), path_.c_str()) != 0)
    {
        const Refusal reason = error();
        discard();
        return reason;
    }
    release_slot(slot_);
    // The data are synced, so an error of close() loses nothing.
    ::close(std::exchange(descriptor_, -1));
    sync_directory(path_.parent_path());
    return Done{};
}

void AtomicFile::discard() noexcept
{
    if (descriptor_ >= 0)
    {
        ::close(std::exchange(descriptor_, -1));
        ::unlink(partial_.c_str());
        release_slot(slot_);
    }
}

Refusal AtomicFile::error() const
{
    return refuse(name_, std::strerror(errno));
}

std::optional<Refusal> probe_output(const std::string& path)
{
    return path.empty() ? std::nullopt : AtomicFile::probe(path);
}

std::optional<Refusal> write_text(const std::string& text, const std::string& path)
{
    auto file = AtomicFile::create(path);
    if (!file)
    {
        return file.error();
    }
    auto done = file.value().write(std::as_bytes(std::span(text)));
    done = done ? file.value().commit() : done;
    return done ? std::nullopt : std::optional(done.error());
}

} // namespace tactus
