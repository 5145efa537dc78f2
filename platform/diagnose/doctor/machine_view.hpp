// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::doctor
{

/// Files of the kernel below a root folder: "/" in the program, a made-up tree in tests. Paths are
/// absolute ("/proc/version"). A failure gives an empty result.
class SystemFiles
{
public:
    static constexpr std::size_t kMostBytes = 64 * 1024; ///< Most bytes read of a file; the rest is
                                                         ///< ignored.
    static constexpr std::size_t kMostNames = 16 * 1024; ///< Most names read of a folder.

    explicit SystemFiles(std::filesystem::path root) : root_(std::move(root)) {}

    /// First kMostBytes of a file; none if it can't be read or is a folder.
    [[nodiscard]] std::optional<std::string> bytes(const std::string& path) const;
    /// Contents without white space at either end.
    [[nodiscard]] std::optional<std::string> text(const std::string& path) const;
    /// Names in a folder, sorted; empty if there is no such folder.
    [[nodiscard]] std::vector<std::string> names(const std::string& path) const;
    [[nodiscard]] bool is_there(const std::string& path) const;
    [[nodiscard]] bool is_folder(const std::string& path) const;

private:
    [[nodiscard]] std::filesystem::path below_root(const std::string& path) const;

    std::filesystem::path root_;
};

/// Most processors, more than any kernel supports.
inline constexpr std::size_t kMostProcessors = 8192;
using ProcessorSet = std::bitset<kMostProcessors>;

// Parsers for the kernel's forms of numbers and processors. Each reads the whole text or nothing.

/// Decimal, with or without a sign.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);
/// Hexadecimal, as "0x1003" or "1003".
[[nodiscard]] std::optional<std::uint64_t> parse_hexadecimal(std::string_view text);
/// List such as "0-3,5"; an empty text is an empty set.
[[nodiscard]] std::optional<ProcessorSet> parse_processor_list(std::string_view text);
/// Mask such as "ff,ffffffff": hexadecimal groups of 32 processors, the highest first.
[[nodiscard]] std::optional<ProcessorSet> parse_processor_mask(std::string_view text);

/// Text such as "0-3,5".
[[nodiscard]] std::string processor_list(const ProcessorSet& set);
/// Text such as "ff,ffffffff".
[[nodiscard]] std::string processor_mask(const ProcessorSet& set);
[[nodiscard]] std::optional<int> lowest_of(const ProcessorSet& set);
[[nodiscard]] std::optional<int> highest_of(const ProcessorSet& set);
[[nodiscard]] ProcessorSet set_of(int processor);

/// True if `list`, separated by white space, contains `word`.
[[nodiscard]] bool has_word(std::string_view list, std::string_view word);

/// Quoted text for display, with printable().
[[nodiscard]] std::string shown(std::string_view text);

/// Text quoted as one word for a shell, safe for any content.
[[nodiscard]] std::string shell_word(std::string_view text);

/// Limit of an unlimited resource.
inline constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// Measured behaviour of the system, as opposed to the contents of its files.
struct Measured
{
    /// Priority of the supervisor, one above the loop's of 80.
    static constexpr int kFifoPriority = 81;
    static constexpr std::uint64_t kClockReads = 64;

    std::string user{"root"};                  ///< User name for limits.conf.
    std::string machine;                       ///< Processor type, such as "x86_64" or "aarch64".
    std::string kernel_version;                ///< Version as uname reports it.
    std::string fifo_refused;                  ///< Name of the errno; empty: granted.
    std::optional<std::uint64_t> rtprio_limit; ///< None: unknown.
    bool memory_lock_granted{true};
    std::optional<std::uint64_t> memlock_limit; ///< Bytes; none: unknown.
    std::optional<std::uint64_t> clock_calls;   ///< System calls in kClockReads reads of the clock.
    std::optional<std::int64_t> clock_resolution_ns;
    bool float_control_is_default{true}; ///< State of a new thread: see reset_float_control().
    std::string preloaded;               ///< LD_PRELOAD.
    std::string dds_uri;                 ///< CYCLONEDDS_URI; empty is the same as unset.
};

/// Measures all fields on short-lived threads, in a few ms at most. The process is left unchanged,
/// except that locked memory becomes unlocked.
[[nodiscard]] Measured measure();

/// Verdict of a check.
enum class Verdict : std::uint8_t
{
    good,
    advice,   ///< The loop runs, but the machine makes it late more often than necessary.
    critical, ///< The loop can't be a real-time thread, can't keep its period, or has no DDS.
    unknown,  ///< The check's source is missing or invalid; `found` names it.
};

inline constexpr std::array<const char*, 4> kVerdictNames{"good", "advice", "critical", "unknown"};

[[nodiscard]] constexpr const char* name_of(Verdict verdict) noexcept
{
    return kVerdictNames[static_cast<std::size_t>(verdict)];
}

/// Result of one check. All texts are printable ASCII without line ends. examine() adds the name
/// and the effect from its table.
struct Finding
{
    std::string name{}; ///< Name of the check: lower-case words joined by '-'.
    Verdict verdict{Verdict::unknown};
    std::string found{};
    std::string why{};                 ///< Effect on the loop.
    std::vector<std::string> remedy{}; ///< Shell commands, in order; empty if the verdict is good.
    /// True if an option requests this check: a good finding is then shown in full, too.
    bool is_asked_for{false};
};

/// Data on the machine for the checks.
struct MachineView
{
    const SystemFiles& files;
    const Measured& measured;
    std::optional<int> cpu; ///< Processor that the loop will be pinned to; none: not chosen.
};

/// Online processors; none if the kernel does not report them.
[[nodiscard]] std::optional<ProcessorSet> online_processors(const SystemFiles& files);

/// Processors of the loop: the chosen one, or all online ones.
[[nodiscard]] std::optional<ProcessorSet> loop_processors(const MachineView& view);

/// Processor given by `--cpu`; otherwise the highest online one, the best choice for `--cpu`. None
/// if unknown.
[[nodiscard]] std::optional<int> chosen_or_highest(const MachineView& view);

/// Text like "processors 0-3" or "processor 2".
[[nodiscard]] std::string processors_in_words(const ProcessorSet& set);

/// Finding with the verdict unknown, because `path` can't be read or has invalid content.
[[nodiscard]] Finding unreadable(const SystemFiles& files, const std::string& path);

/// Command that adds arguments to the kernel's line permanently, in Debian's way.
[[nodiscard]] std::string add_to_kernel_line(const std::string& arguments);

} // namespace tactus::doctor
