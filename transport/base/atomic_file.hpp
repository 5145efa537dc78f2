// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace tactus
{

/// A file that appears as a whole or not at all. write() goes to a partial file beside it,
/// PATH.PID-N.partial; commit() syncs that file and renames it. Without commit() the destructor
/// removes it. One thread at a time; different files may be written on different threads. Every
/// refusal names the path and the reason.
class AtomicFile
{
public:
    /// Maximum number of open partial files in one process. The signal handler finds them in memory
    /// of fixed size.
    static constexpr std::size_t kMaxPending = 16;

    /// Creates the partial file beside `path`. If `path` is a link, its target is replaced; in a
    /// folder like /tmp, a link of another user is replaced itself. Refused if `path` is not a
    /// regular file, or if its directory is missing or cannot be written.
    [[nodiscard]] static Result<AtomicFile, Refusal> create(const std::filesystem::path& path);

    /// Tests, before a long run, whether `path` can be written; leaves no file. Returns the reason
    /// if not.
    [[nodiscard]] static std::optional<Refusal> probe(const std::filesystem::path& path);

    /// Installs handlers for SIGINT, SIGTERM and SIGHUP that remove every partial file and then end
    /// the process as usual. Ignored signals stay ignored. Replaces the program's own handlers.
    static void remove_pending_on_signal();

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Appends bytes at bytes(), which write_at() does not change.
    [[nodiscard]] Result<Done, Refusal> write(std::span<const std::byte> bytes);
    /// Overwrites or extends the file at a byte offset.
    [[nodiscard]] Result<Done, Refusal> write_at(std::uint64_t offset,
                                                 std::span<const std::byte> bytes);
    /// Syncs the partial file and renames it to `path`. If refused, the old file is unchanged and
    /// the partial file is removed. Write nothing afterwards.
    [[nodiscard]] Result<Done, Refusal> commit();

    /// Position of the next write().
    [[nodiscard]] std::uint64_t bytes() const noexcept { return end_; }

private:
    AtomicFile(std::string name, std::filesystem::path path, std::filesystem::path partial,
               int descriptor, std::size_t slot);

    void discard() noexcept;
    [[nodiscard]] Refusal error() const;

    std::string name_; ///< Path as given; for messages.
    std::filesystem::path path_;
    std::filesystem::path partial_;
    int descriptor_{-1}; ///< File descriptor; -1 once committed, discarded or moved from.
    std::size_t slot_{0};
    std::uint64_t end_{0};
};

/// Tests, before a long run, whether a file can be written; returns the reason if not. An empty
/// path passes.
[[nodiscard]] std::optional<Refusal> probe_output(const std::string& path);

/// Writes a text file as a whole or not at all; returns the reason if it fails.
[[nodiscard]] std::optional<Refusal> write_text(const std::string& text, const std::string& path);

} // namespace tactus
