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

/// Where a program of ours is: in the folder of this one, or where the tests' programs are.
[[nodiscard]] std::filesystem::path program_path(const std::string& name);

/// A program to start, and what surrounds it.
struct ProgramSetup
{
    std::vector<std::string> words; ///< Path and arguments.
    std::string network;            ///< File of the network namespace it lives in; empty: ours.
    std::string dds_uri;            ///< Its CYCLONEDDS_URI; empty: none.
    std::filesystem::path output;   ///< Where stdout and stderr go.
    /// stdin and stdout are the two ends of a talk, see ask(); stderr goes to `output`.
    bool is_asked{false};
};

/// The line of JSON in a program's output.
[[nodiscard]] nlohmann::json report_in(const std::filesystem::path& output);

/// A running program; it is killed when this goes. It may use every processor, whatever the caller
/// is held to.
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
    /// Waits until it has ended; a failure that quotes its last line when not with code 0.
    void wait();
    /// Waits until its output holds the text.
    void wait_for(const std::string& text, std::chrono::seconds timeout) const;
    /// Reads one line, after sending another one unless that is empty.
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

    pid_t id_{0}; ///< 0: there is none.
    std::string name_;
    std::filesystem::path output_;
    int talk_{-1};
};

} // namespace tactus::bench
