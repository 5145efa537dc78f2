// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording.hpp"

#include "rt_core/base/crc32c.hpp"
#include "rt_core/frame/frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

namespace tactus
{

namespace
{

/// As much as `hrtc --pool-mib` can be; a recording that needs more was never made.
constexpr std::size_t kMaxReplayBytes = std::size_t{4'096} << 20U;

constexpr const char* kNotARecording = "is not a Tactus recording: it doesn't begin with TACTREC";

bool is_within(double value, double least, double most)
{
    return value >= least && value <= most; // False for NaN.
}

bool is_sound(const ToolSpec& tool)
{
    return is_within(tool.radius_m, 1e-9, 1e6) && is_within(tool.stiffness_n_per_m, 0.0, 1e9) &&
           is_within(tool.force_max_n, 0.0, 1e9) && is_within(tool.speed_max_m_per_s, 0.0, 1e9);
}

std::string read_name(ByteReader& reader)
{
    const auto bytes = reader.read_bytes(reader.read<std::uint8_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Names are printed; a recording must not move the terminal's cursor.
bool is_sound(const std::string& name)
{
    return name.size() <= kMaxRecordedNameBytes &&
           std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

} // namespace

/// Goes through the sections once. Every parse_ function returns what is wrong, or nothing.
class RecordingParser
{
public:
    RecordingParser(std::span<const std::byte> bytes, std::string name)
        : bytes_(bytes), name_(std::move(name))
    {
    }

    [[nodiscard]] Result<Recording, RecordingError> parse()
    {
        std::optional<std::string> fault = parse_prologue();
        while (!fault && !has_end_)
        {
            fault = parse_section();
        }
        if (!fault && at_ != bytes_.size())
        {
            fault = "the end section is followed by " + std::to_string(bytes_.size() - at_) +
                    " bytes; nothing may follow it";
        }
        if (fault)
        {
            return RecordingError{name_ + ": at byte " + std::to_string(at_) + ": " + *fault};
        }
        return std::move(recording_);
    }

private:
    using Fault = std::optional<std::string>;

    Fault parse_prologue()
    {
        const std::size_t magic_bytes = std::min(bytes_.size(), kRecordingMagic.size());
        if (magic_bytes == 0)
        {
            return "the file is empty";
        }
        if (std::memcmp(bytes_.data(), kRecordingMagic.data(), magic_bytes) != 0)
        {
            return kNotARecording;
        }
        if (bytes_.size() < kRecordingPrologueBytes)
        {
            return cut_short(kRecordingPrologueBytes);
        }
        ByteReader reader(bytes_.subspan(kRecordingMagic.size()));
        const auto version = reader.read<std::uint32_t>();
        if (version != kRecordingVersion)
        {
            at_ = kRecordingMagic.size();
            return "format version " + std::to_string(version) +
                   " is unknown; this program reads " + std::to_string(kRecordingVersion);
        }
        at_ = kRecordingPrologueBytes;
        return std::nullopt;
    }

    [[nodiscard]] std::string cut_short(std::size_t needed) const
    {
        return "the file is cut short: " + std::to_string(needed) + " bytes are needed here and " +
               std::to_string(bytes_.size() - at_) + " are left";
    }

    Fault parse_section()
    {
        const std::span<const std::byte> rest = bytes_.subspan(at_);
        if (rest.size() < kSectionHeaderBytes)
        {
            return cut_short(kSectionHeaderBytes);
        }
        ByteReader reader(rest);
        const auto kind = reader.read<std::uint32_t>();
        const auto size = reader.read<std::uint32_t>();
        const auto checksum = reader.read<std::uint32_t>();
        if (kind < static_cast<std::uint32_t>(SectionKind::setup) ||
            kind > static_cast<std::uint32_t>(SectionKind::end))
        {
            return "section kind " + std::to_string(kind) + " is unknown; 1 to 5 are allowed";
        }
        if (size > reader.remaining())
        {
            return cut_short(kSectionHeaderBytes + std::size_t{size});
        }
        std::vector<std::byte> covered(rest.begin(), rest.begin() + 8);
        const std::span<const std::byte> payload = reader.read_bytes(size);
        covered.insert(covered.end(), payload.begin(), payload.end());
        if (crc32c(covered) != checksum)
        {
            return "section of kind " + std::to_string(kind) + " and " + std::to_string(size) +
                   " bytes is damaged: its checksum does not fit";
        }
        if (Fault fault = parse_payload(static_cast<SectionKind>(kind), payload))
        {
            return fault;
        }
        at_ += kSectionHeaderBytes + size;
        return std::nullopt;
    }

    Fault parse_payload(SectionKind kind, std::span<const std::byte> payload)
    {
        const bool wants_setup = !has_setup_;
        const bool wants_model = has_setup_ && recording_.setup_.models.size() < model_count_;
        if (wants_setup != (kind == SectionKind::setup) ||
            (!wants_setup && wants_model != (kind == SectionKind::model)))
        {
            return "a section is out of order: the setup comes first, then " +
                   std::to_string(model_count_) + " models, then pieces and frames";
        }
        switch (kind)
        {
        case SectionKind::setup:
            return parse_setup(payload);
        case SectionKind::model:
            return parse_model(payload);
        case SectionKind::piece:
            return parse_piece(payload);
        case SectionKind::frames:
            return parse_frames(payload);
        case SectionKind::end:
            return parse_end(payload);
        }
        return std::nullopt;
    }

    Fault parse_setup(std::span<const std::byte> payload)
    {
        RecordedSetup& setup = recording_.setup_;
        ByteReader reader(payload);
        setup.period_ns = reader.read<std::int64_t>();
        setup.pose_age_max_ns = reader.read<std::int64_t>();
        const auto is_static = reader.read<std::uint8_t>();
        setup.static_when_it_fits = is_static != 0;
        const auto tools = reader.read<std::uint8_t>();
        const auto objects = reader.read<std::uint8_t>();
        model_count_ = reader.read<std::uint8_t>();
        if (tools < 1 || tools > kMaxTools || objects < 1 || objects > kMaxObjects ||
            model_count_ < 1 || model_count_ > kMaxModels)
        {
            return "the setup has " + std::to_string(tools) + " tools, " + std::to_string(objects) +
                   " objects and " + std::to_string(model_count_) +
                   " models; 1 to 4, 1 to 8 and 1 to 8 are allowed";
        }
        if (is_static > 1)
        {
            return "the static mode is neither on (1) nor off (0)";
        }
        if (setup.period_ns < 1 || setup.period_ns > 1'000'000'000)
        {
            return "the period is " + std::to_string(setup.period_ns) +
                   " ns; 1 to 1000000000 are allowed";
        }
        for (std::uint32_t i = 0; i < tools; ++i)
        {
            const ToolSpec tool{reader.read<double>(), reader.read<double>(), reader.read<double>(),
                                reader.read<double>()};
            if (!is_sound(tool))
            {
                return "tool " + std::to_string(i) +
                       " is not within 1e-9 to 1e6 m, 0 to 1e9 N/m, 0 to 1e9 N, 0 to 1e9 m/s";
            }
            setup.tools.push_back(tool);
        }
        for (std::uint32_t i = 0; i < objects; ++i)
        {
            setup.objects.push_back({ModelId{reader.read<std::uint32_t>()}});
            if (setup.objects.back().model.value >= model_count_)
            {
                return "object " + std::to_string(i) + " names a model beyond the " +
                       std::to_string(model_count_) + " there are";
            }
        }
        for (std::string* name : {&setup.compiler, &setup.architecture, &setup.kernels})
        {
            *name = read_name(reader);
            if (!is_sound(*name))
            {
                return "a name in the setup is not of at most 63 printable characters";
            }
        }
        has_setup_ = true;
        return whole(reader, "setup");
    }

    static Fault whole(const ByteReader& reader, const char* section)
    {
        return reader.failed() || !reader.at_end()
                   ? Fault(std::string("the ") + section + " section has another size than its " +
                           "content")
                   : std::nullopt;
    }

    Fault parse_model(std::span<const std::byte> payload)
    {
        RecordedModel model;
        ByteReader reader(payload);
        ModelCapacities& capacities = model.capacities;
        for (std::uint32_t* capacity : {&capacities.pages, &capacities.index_pages,
                                        &capacities.faces, &capacities.blocks, &capacities.nodes})
        {
            *capacity = reader.read<std::uint32_t>();
        }
        const auto cache_off = reader.read<std::uint8_t>();
        capacities.cache_off = cache_off != 0;
        const auto header = reader.read_bytes(reader.read<std::uint32_t>());
        const auto base = reader.read_bytes(reader.remaining());
        model.header.assign(header.begin(), header.end());
        model.base.assign(base.begin(), base.end());
        if (reader.failed())
        {
            return whole(reader, "model");
        }
        const auto parsed = ModelHeader::parse(model.header);
        if (!parsed)
        {
            return std::string("the model's header is damaged: ") + refusal_text(parsed.error());
        }
        const std::uint32_t base_faces = parsed.value().counts().base_faces;
        const std::uint32_t least = std::min(
            {capacities.pages, capacities.index_pages, capacities.blocks, capacities.nodes});
        if (least == 0 || capacities.faces < base_faces || cache_off > 1)
        {
            return "a pool's capacity is below 1, there are fewer than the base mesh's " +
                   std::to_string(base_faces) +
                   " faces, or the cache is neither off (1) nor on (0)";
        }
        needed_bytes_ += required_bytes(parsed.value(), capacities);
        if (needed_bytes_ > kMaxReplayBytes)
        {
            return "the pools need more than 4096 MiB, which is the most there can be";
        }
        counts_.push_back(parsed.value().counts());
        recording_.setup_.models.push_back(std::move(model));
        if (recording_.setup_.models.size() == model_count_)
        {
            decoder_.emplace(recording_.shape());
        }
        return std::nullopt;
    }

    Fault parse_piece(std::span<const std::byte> payload)
    {
        ByteReader reader(payload);
        const auto model = reader.read<std::uint8_t>();
        const auto kind = static_cast<ContentKind>(reader.read<std::uint8_t>());
        const auto number = reader.read<std::uint32_t>();
        const auto bytes = reader.read_bytes(reader.remaining());
        const bool is_chunk = kind == ContentKind::chunk;
        const bool is_known =
            !reader.failed() && model < model_count_ &&
            (is_chunk ? number < counts_[model].chunks()
                      : kind == ContentKind::index_page && number < counts_[model].index_pages());
        if (!is_known)
        {
            return "a piece is not a chunk or index page of one of the recording's models";
        }
        if (bytes.empty() || bytes.size() > kMaxCodedChunkBytes)
        {
            return "a piece has " + std::to_string(bytes.size()) + " bytes; 1 to " +
                   std::to_string(kMaxCodedChunkBytes) + " are allowed";
        }
        const bool is_new = recording_.pieces_
                                .try_emplace({model, kind, number},
                                             std::vector<std::byte>(bytes.begin(), bytes.end()))
                                .second;
        return is_new ? std::nullopt : Fault("a piece is in the recording twice");
    }

    Fault parse_frames(std::span<const std::byte> payload)
    {
        if (payload.empty() || payload.size() > kMaxFramesSectionBytes)
        {
            return "a frames section has " + std::to_string(payload.size()) + " bytes; 1 to " +
                   std::to_string(kMaxFramesSectionBytes) + " are allowed";
        }
        for (ByteReader reader(payload); !reader.at_end(); ++recording_.frame_count_)
        {
            Fault fault;
            if (const char* text = decoder_->decode(reader))
            {
                fault = text;
            }
            else
            {
                fault = check_pieces(decoder_->frame());
            }
            if (fault)
            {
                return "frame " + std::to_string(recording_.frame_count_) + " " + *fault;
            }
        }
        recording_.frames_.insert(recording_.frames_.end(), payload.begin(), payload.end());
        return std::nullopt;
    }

    /// What arrives must have been recorded before.
    Fault check_pieces(const RecordedFrame& frame) const
    {
        for (std::uint32_t model = 0; model < frame.doors.size(); ++model)
        {
            const ModelCapacities& capacities = recording_.setup_.models[model].capacities;
            for (const DoorEvent& event : frame.doors[model].events)
            {
                const std::uint32_t slots = event.key.kind == ContentKind::chunk
                                                ? capacities.pages
                                                : capacities.index_pages;
                if (event.slot >= slots)
                {
                    return "names slot " + std::to_string(event.slot) + " of " +
                           std::to_string(slots);
                }
                if (recording_.piece(model, event.key).empty())
                {
                    return "takes piece " + std::to_string(event.key.number) +
                           " from the door, which is not in the recording before it";
                }
            }
        }
        return std::nullopt;
    }

    Fault parse_end(std::span<const std::byte> payload)
    {
        ByteReader reader(payload);
        const auto frames = reader.read<std::uint64_t>();
        recording_.lost_from_ = reader.read<std::uint64_t>();
        const auto pieces = reader.read<std::uint64_t>();
        if (Fault fault = whole(reader, "end"))
        {
            return fault;
        }
        if (frames != recording_.frame_count_ || pieces != recording_.pieces_.size())
        {
            return "the end states " + std::to_string(frames) + " frames and " +
                   std::to_string(pieces) + " pieces, but " +
                   std::to_string(recording_.frame_count_) + " and " +
                   std::to_string(recording_.pieces_.size()) + " came before";
        }
        if (recording_.lost_from_ != kNoFrame && recording_.lost_from_ != frames)
        {
            return "the first lost frame is " + std::to_string(recording_.lost_from_) + "; after " +
                   std::to_string(frames) + " frames only that number is allowed";
        }
        has_end_ = true;
        return std::nullopt;
    }

    std::span<const std::byte> bytes_;
    std::string name_;
    std::size_t at_{0};
    Recording recording_;
    std::uint32_t model_count_{0};
    bool has_setup_{false};
    bool has_end_{false};
    std::size_t needed_bytes_{0};
    std::vector<ModelCounts> counts_;
    std::optional<FrameDecoder> decoder_;
};

Result<Recording, RecordingError> Recording::parse(std::span<const std::byte> bytes,
                                                   const std::string& name)
{
    return RecordingParser(bytes, name).parse();
}

Result<Recording, RecordingError> Recording::read(const std::string& path)
{
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
    if (size < 0 || size == std::numeric_limits<std::streamoff>::max())
    {
        return RecordingError{path + ": can't be opened as a file"};
    }
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    file.seekg(0);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), size))
    {
        return RecordingError{path + ": can't be read to its end, byte " + std::to_string(size)};
    }
    return parse(bytes, path);
}

std::span<const std::byte> Recording::piece(std::uint32_t model, ContentKey key) const noexcept
{
    const auto at = pieces_.find({model, key.kind, key.number});
    return at == pieces_.end() ? std::span<const std::byte>{} : std::span(at->second);
}

} // namespace tactus
