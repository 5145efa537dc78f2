// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a recording. Version and checksums are made right, or its content would not be
/// parsed. All frames of an accepted one are decoded again.
#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "tests/fuzz/law.hpp"

#include <cstring>
#include <span>
#include <vector>

namespace tactus::fuzz
{

namespace
{

constexpr const char* kName = "fuzzed.rec";
constexpr std::size_t kChecked = 8; ///< Bytes of a section's header before its checksum.

template <typename T>
T number_at(std::span<const std::byte> bytes, std::size_t at)
{
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

/// Corrects the version, and the checksums of all sections that are as long as they state.
void seal_recording(std::vector<std::byte>& bytes)
{
    if (bytes.size() < kRecordingPrologueBytes)
    {
        return;
    }
    std::memcpy(bytes.data() + kRecordingMagic.size(), &kRecordingVersion,
                sizeof(kRecordingVersion));
    std::size_t at = kRecordingPrologueBytes;
    while (bytes.size() - at >= kSectionHeaderBytes)
    {
        const std::span<std::byte> section = std::span(bytes).subspan(at);
        const std::size_t size = number_at<std::uint32_t>(section, sizeof(std::uint32_t));
        if (size > section.size() - kSectionHeaderBytes)
        {
            return;
        }
        std::vector<std::byte> covered(section.begin(),
                                       section.begin() + static_cast<std::ptrdiff_t>(kChecked));
        const auto payload = section.subspan(kSectionHeaderBytes, size);
        covered.insert(covered.end(), payload.begin(), payload.end());
        const std::uint32_t sum = crc32c(covered);
        std::memcpy(section.data() + kChecked, &sum, sizeof(sum));
        at += kSectionHeaderBytes + size;
    }
}

void check_recording(const Recording& recording)
{
    FrameDecoder decoder(recording.shape());
    ByteReader reader(recording.frames());
    for (std::uint64_t frame = 0; frame < recording.frame_count(); ++frame)
    {
        require(decoder.decode(reader) == nullptr, "an accepted frame is decoded again");
        require(decoder.frame().tools.size() == recording.setup().tools.size() &&
                    decoder.frame().devices.size() == recording.setup().tools.size(),
                "a frame has all tools");
    }
    require(reader.at_end(), "the frames are counted");
    const std::string missing = recording.missing();
    require(missing.empty() || is_one_clear_line(missing), "what is missing is one clear line");
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus;
    const std::span<const std::byte> input = std::as_bytes(std::span(data, size));
    std::vector<std::byte> bytes(input.begin(), input.end());
    fuzz::seal_recording(bytes);
    const auto recording = Recording::parse(bytes, fuzz::kName);
    if (!recording)
    {
        fuzz::require(fuzz::is_clear_refusal(recording.error().text, fuzz::kName),
                      "a refusal is one clear line that begins with the file's name");
        return 0;
    }
    ++fuzz::accepted_inputs;
    fuzz::check_recording(recording.value());
    return 0;
}
