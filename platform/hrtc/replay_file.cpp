// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/frame_export.hpp"
#include "platform/hrtc/subcommands.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "platform/recording/recording.hpp"
#include "platform/recording/replay.hpp"
#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Export files of a replay.
class Exports
{
public:
    /// Opens all files. Returns the refusal of the first that can't be written.
    [[nodiscard]] std::optional<Refusal> open(const std::vector<std::string>& paths,
                                              const RecordedSetup& setup)
    {
        for (const std::string& path : paths)
        {
            auto file = FrameExport::create(path, setup);
            if (!file)
            {
                return Refusal{"--export: " + file.error().text};
            }
            files_.emplace_back(path, std::move(file).value());
        }
        return std::nullopt;
    }

    void add(std::uint64_t number, const RecordedFrame& given, const FrameOutput& returned)
    {
        first_time_ns_ = number == 0 ? given.now_ns : first_time_ns_;
        for (const auto& [path, file] : files_)
        {
            file->add({number, first_time_ns_, given, returned});
        }
    }

    /// Commits all files. Returns the refusal of the first that can't be written.
    [[nodiscard]] std::optional<Refusal> commit()
    {
        for (const auto& [path, file] : files_)
        {
            if (const auto written = file->commit(); !written)
            {
                return Refusal{"--export: " + written.error().text};
            }
            print_out(fmt::format("export      {}\n", printable_line(path)));
        }
        return std::nullopt;
    }

private:
    std::vector<std::pair<std::string, std::unique_ptr<FrameExport>>> files_;
    std::int64_t first_time_ns_{0};
};

} // namespace

int replay_file(const std::string& path, const Kernels* kernels,
                const std::vector<std::string>& exports, const Log& log)
{
    const auto recording = Recording::read(path);
    if (!recording)
    {
        log(recording.error().text);
        return kExitFailed;
    }
    Exports files;
    if (const auto error = files.open(exports, recording.value().setup()))
    {
        log(error->text);
        return kExitFailed;
    }
    ReplayWatch watch;
    watch.begins = [&](std::uint64_t number)
    {
        if (recording.value().has_failed() && number + 1 == recording.value().frame_count())
        {
            log(fmt::format("{}: frame {}, which failed in the run, runs now", path, number));
        }
    };
    watch.ends = [&](std::uint64_t number, const RecordedFrame& given, const FrameOutput& returned)
    { files.add(number, given, returned); };
    const auto replayed = replay(recording.value(), kernels, watch);
    if (!replayed)
    {
        log(path + ": " + replayed.error().text);
        return kExitFailed;
    }
    const std::string line = replay_line(recording.value(), replayed.value());
    if (replayed.value().difference)
    {
        log(path + ": " + line);
        return kExitCriterionNotMet;
    }
    print_out(fmt::format("{}: {}\n", printable(path), line));
    if (const auto error = files.commit())
    {
        log(error->text);
        return kExitFailed;
    }
    return kExitDone;
}

} // namespace tactus::hrtc
