// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/export/field_sink.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace tactus
{

/// True if the name ends in .csv, .jsonl or .mcap.
[[nodiscard]] bool is_export_name(std::string_view path) noexcept;

/// Writes replayed frames into a file for other tools, in the format of its name's ending
/// (docs/recording.md). The file is complete or absent. One thread, not the haptic one: it
/// allocates and waits for the file.
class FrameExport
{
public:
    /// Opens an export. Refused in one line if the file can't be written. is_export_name(path) must
    /// hold (asserted); `setup` must outlive the export.
    [[nodiscard]] static Result<std::unique_ptr<FrameExport>, Refusal>
    create(const std::string& path, const RecordedSetup& setup);
    FrameExport(const FrameExport&) = delete;
    FrameExport& operator=(const FrameExport&) = delete;
    virtual ~FrameExport() = default;

    /// Adds the next frame. After an error frames are dropped; commit() reports it.
    virtual void add(const ReplayedFrameView& frame) = 0;
    /// Completes the file and gives it its name. Call once, last; without commit() no file is left.
    [[nodiscard]] virtual Result<Done, Refusal> commit() = 0;

protected:
    FrameExport() = default;
};

} // namespace tactus
