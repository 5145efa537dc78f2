// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::doctor
{

/// A machine that has nothing but what a test gives it, in a folder that vanishes with it.
class MadeUpMachine
{
public:
    MadeUpMachine();
    ~MadeUpMachine();
    MadeUpMachine(const MadeUpMachine&) = delete;
    MadeUpMachine& operator=(const MadeUpMachine&) = delete;

    /// A file with this content, in folders that are made for it.
    void put(const std::string& path, const std::string& content) const;
    void put_folder(const std::string& path) const;
    /// A file or folder, with all that is in it.
    void take_away(const std::string& path) const;
    /// What is in a file, line ends included.
    [[nodiscard]] std::string content_of(const std::string& path) const;
    /// All files that there are, as paths of the machine.
    [[nodiscard]] std::vector<std::string> paths() const;

    /// Runs a command as a shell would that has this machine's /proc, /sys and /etc and every
    /// right; nothing behind "&& update-grub".
    void run(const std::string& command) const;

    [[nodiscard]] const SystemFiles& files() const noexcept { return files_; }
    [[nodiscard]] MachineView view() const noexcept { return {files_, measured, cpu}; }

    Measured measured;
    std::optional<int> cpu;

private:
    std::filesystem::path root_;
    SystemFiles files_;
};

/// Makes it one on which every check is good: four processors, the last one isolated for the loop.
void make_good(MadeUpMachine& machine);

} // namespace tactus::doctor
