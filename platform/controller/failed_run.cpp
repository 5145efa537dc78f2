// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/failed_run.hpp"

#include "platform/recording/last_inputs.hpp"
#include "platform/recording/recording_writer.hpp"
#include "transport/base/atomic_file.hpp"

#include <filesystem>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace tactus::hrtc
{

namespace
{

Result<Done, Refusal> write_whole(const std::filesystem::path& path,
                                  std::span<const std::byte> bytes)
{
    auto file = AtomicFile::create(path);
    if (!file)
    {
        return file.error();
    }
    const auto written = file.value().write(bytes);
    return written ? file.value().commit() : written;
}

} // namespace

Result<KeptInputs, Refusal> write_last_inputs(const LastInputs& inputs,
                                              const std::optional<GivenFrame>& failed,
                                              const FrameSetup& setup)
{
    RecordingWriter writer(to_recorded(setup));
    inputs.write_to(writer);
    if (failed) // The pieces that this frame took from the queues are not kept.
    {
        FrameEncoder encoder;
        writer.add_frame(encoder.encode_given({failed->input, {}, failed->devices}));
    }
    writer.finish(kNoFrame);
    const std::vector<std::byte> bytes = writer.take_bytes();
    std::filesystem::path path = "hrtc-failed-" + std::to_string(getpid()) + ".rec";
    auto written = write_whole(path, bytes);
    if (!written)
    {
        std::error_code code;
        path = std::filesystem::temp_directory_path(code) / path;
        written = write_whole(path, bytes);
    }
    if (!written)
    {
        return written.error();
    }
    return KeptInputs{path.string(), writer.frames()};
}

} // namespace tactus::hrtc
