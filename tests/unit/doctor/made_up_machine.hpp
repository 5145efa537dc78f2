// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::doctor
{

/// Machine with only the content that a test adds, in a folder that is removed with it.
struct MadeUpMachine
{
    MadeUpMachine();
    ~MadeUpMachine();
    MadeUpMachine(const MadeUpMachine&) = delete;
    MadeUpMachine& operator=(const MadeUpMachine&) = delete;

    /// Writes a file with this content, and its folders.
    void put(const std::string& path, const std::string& content) const;
    void put_folder(const std::string& path) const;
    /// Removes a file, or a folder with its content.
    void take_away(const std::string& path) const;
    /// Content of a file, including line ends.
    [[nodiscard]] std::string content_of(const std::string& path) const;
    /// All files, as paths of the machine.
    [[nodiscard]] std::vector<std::string> paths() const;

    /// Runs a command like a shell on this machine's /proc, /sys and /etc with all rights; nothing
    /// after "&& update-grub".
    void run(const std::string& command) const;

    [[nodiscard]] const SystemFiles& files() const noexcept { return files_; }
    [[nodiscard]] MachineView view() const noexcept { return {files_, measured, cpu}; }

    Measured measured;
    std::optional<int> cpu;

private:
    std::filesystem::path root_;
    SystemFiles files_;
};

/// Sets up a machine on which every check is good: four processors, the last one isolated for the
/// loop.
void make_good(MadeUpMachine& machine);

} // namespace tactus::doctor
