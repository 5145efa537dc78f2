// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
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

} // namespace tactus::bench
