// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

namespace tactus::bench
{

/// Path of a program: in the folder of this one, or in that of the tests' programs.
[[nodiscard]] std::filesystem::path program_path(const std::string& name);

/// Program to start, with its environment.
struct ProgramSetup
{
    std::vector<std::string> words; ///< Path and arguments.
    std::string network;            ///< File of its network namespace; empty: ours.
    std::string dds_uri;            ///< CYCLONEDDS_URI of the program; empty: none.
    std::filesystem::path output;   ///< File of stdout and stderr.
    /// True if stdin and stdout are connected to ask(); stderr goes to `output`.
    bool is_asked{false};
};

/// JSON line of a program's output.
[[nodiscard]] nlohmann::json report_in(const std::filesystem::path& output);

/// Running program; killed by the destructor. It may use every processor, even if the caller is
/// pinned.
class Program
{
public:
    [[nodiscard]] static Program start(const ProgramSetup& setup);
    Program(Program&& other) noexcept { swap(other); }
    Program& operator=(Program&& other) noexcept
    {
        swap(other);
        return *this;
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    [[nodiscard]] pid_t id() const { return id_; }
    void send_signal(int signal) const { ::kill(id_, signal); }
    /// Waits for the end; a failure with the last line of output if the exit code is not 0.
    void wait();
    /// Waits until the output contains the text.
    void wait_for(const std::string& text, std::chrono::seconds timeout) const;
    /// Sends a line unless it is empty, then reads one.
    [[nodiscard]] std::string ask(const std::string& line);

private:
    Program() = default;
    void swap(Program& other) noexcept
    {
        std::swap(id_, other.id_);
        std::swap(name_, other.name_);
        std::swap(output_, other.output_);
        std::swap(talk_, other.talk_);
    }
    [[nodiscard]] std::string output_text() const;

    pid_t id_{0}; ///< Process id; 0: none.
    std::string name_;
    std::filesystem::path output_;
    int talk_{-1};
};

/// Properties of the link between two networks, each way.
struct LinkManner
{
    double delay_ms{10.0};
    double loss{0.0};
};

/// One end: the network of a program and its DDS configuration. Default: this machine's loopback
/// interface, which our programs configure themselves.
struct NetworkEnd
{
    std::string network; ///< ProgramSetup::network.
    std::string dds_uri;
};

/// UDP payload through the relay, both directions together.
struct LinkTraffic
{
    std::uint64_t payload_bytes{0};
    std::uint64_t datagrams{0};
};

/// Two networks and the relay between them (tests/relay). Requires root and /dev/net/tun.
class RelayedNetworks
{
public:
    [[nodiscard]] static RelayedNetworks make(const LinkManner& manner,
                                              const std::filesystem::path& folder);

    [[nodiscard]] const NetworkEnd& server() const { return server_; }
    [[nodiscard]] const NetworkEnd& controller() const { return controller_; }
    [[nodiscard]] LinkTraffic traffic();

private:
    explicit RelayedNetworks(Program relay) : relay_(std::move(relay)) {}

    Program relay_;
    NetworkEnd server_;
    NetworkEnd controller_;
};

inline constexpr std::chrono::seconds kStartTimeout{60};

/// DDS domain of this process and its programs, very likely unused by others on this machine.
[[nodiscard]] std::uint32_t dds_domain();

/// Starts one of our programs at an end, in our DDS domain. Its output goes to a file with its name
/// in the folder.
[[nodiscard]] Program start_at(const NetworkEnd& end, const std::string& name,
                               const std::filesystem::path& folder,
                               const std::vector<std::string>& arguments);

/// Starts spm_publish with this scene as "model" and waits until it is ready.
[[nodiscard]] Program publish(const Scene& scene, const NetworkEnd& end,
                              const std::filesystem::path& folder);

struct ChildOutcome
{
    std::string text; ///< Return value of the work.
    /// Peak of resident memory, inherited memory included; 0 if the system does not report it.
    std::uint64_t peak_bytes{0};
};

/// Runs `work` in a child process and waits for it, so that its memory peak is its own. Its changes
/// are not visible to the caller, which must have no other threads. A failure if the work has one,
/// throws or is ended by a signal, or if the system grants no process.
[[nodiscard]] ChildOutcome run_in_child(const std::function<std::string()>& work);

} // namespace tactus::bench
