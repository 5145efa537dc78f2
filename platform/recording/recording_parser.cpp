// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording.hpp"
#include "platform/recording/setup_coding.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/frame/model.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/refusal.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

namespace tactus
{

namespace
{

/// Number of zero bytes at the end of a file that shows an incomplete section. A complete section
/// has fewer: an end section has 12 at most.
constexpr std::size_t kLostZeros = 512;
/// Longest section except frames; a greater length is damaged. A model section has at most 8 MiB of
/// header and 1 MiB of base mesh.
constexpr std::size_t kMaxOtherSectionBytes = std::size_t{16} << 20U;

constexpr const char* kNotARecording = "is not a Tactus recording: it doesn't begin with TACTREC";

} // namespace

/// Reads the sections of a file once, in order. Every parse_ function returns the fault, if any.
class RecordingParser
{
public:
    RecordingParser(std::span<const std::byte> bytes, std::string name)
        : bytes_(bytes), name_(std::move(name)), data_end_(bytes.size())
    {
        while (data_end_ > 0 && bytes[data_end_ - 1] == std::byte{0})
        {
            --data_end_;
        }
    }

    [[nodiscard]] Result<Recording, Refusal> parse()
    {
        std::optional<std::string> fault = parse_prologue();
        while (!fault && !has_end_ && !is_cut())
        {
            fault = parse_section();
        }
        if (!fault && !has_end_)
        {
            fault = end_where_cut();
        }
        else if (!fault && at_ != bytes_.size())
        {
            fault = counted(bytes_.size() - at_, "byte") +
                    " after the end section, which must be the last";
        }
        if (fault)
        {
            return Refusal{name_ + ": at byte " + std::to_string(at_) + ": " + *fault};
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
                   (version < kRecordingVersion ? " is from an older version of Tactus"
                                                : " is unknown") +
                   "; this program reads " + std::to_string(kRecordingVersion);
        }
        at_ = kRecordingPrologueBytes;
        return std::nullopt;
    }

    /// True if the file ends within the next section, or has only zeros from a point within it:
    /// after a power loss a file system may keep a length without the content.
    [[nodiscard]] bool is_cut() const
    {
        const std::span<const std::byte> rest = bytes_.subspan(at_);
        if (rest.size() < kSectionHeaderBytes || at_ >= data_end_)
        {
            return true;
        }
        ByteReader reader(rest);
        const auto kind = reader.read<std::uint32_t>();
        const std::size_t end = at_ + kSectionHeaderBytes + reader.read<std::uint32_t>();
        const std::size_t most = kind == static_cast<std::uint32_t>(SectionKind::frames)
                                     ? kMaxFramesSectionBytes
                                     : kMaxOtherSectionBytes;
        const bool is_cut_off = end > bytes_.size() && end - at_ - kSectionHeaderBytes <= most;
        return is_known(kind) &&
               (is_cut_off || (bytes_.size() - data_end_ >= kLostZeros && end > data_end_));
    }

    static bool is_known(std::uint32_t kind)
    {
        return kind >= static_cast<std::uint32_t>(SectionKind::setup) &&
               kind <= static_cast<std::uint32_t>(SectionKind::name);
    }

    /// Accepts the part up to here if it has at least one frame.
    Fault end_where_cut()
    {
        if (recording_.frame_count_ == 0)
        {
            return "the file is cut short: no frame is complete";
        }
        recording_.cut_at_ = at_;
        return std::nullopt;
    }

    [[nodiscard]] std::string cut_short(std::size_t needed) const
    {
        return "the file is cut short: " + std::to_string(needed) +
               " bytes are needed at this point, but " + std::to_string(bytes_.size() - at_) +
               " are left";
    }

    Fault parse_section()
    {
        const std::span<const std::byte> rest = bytes_.subspan(at_);
        ByteReader reader(rest);
        const auto kind = reader.read<std::uint32_t>();
        const auto size = reader.read<std::uint32_t>();
        const auto checksum = reader.read<std::uint32_t>();
        if (!is_known(kind))
        {
            return "section kind " + std::to_string(kind) + " is unknown; 1 to 6 are allowed";
        }
        if (size > reader.remaining())
        {
            return "section of kind " + std::to_string(kind) + " states a size of " +
                   std::to_string(size) + " bytes, but " + std::to_string(reader.remaining()) +
                   " are left";
        }
        std::vector<std::byte> covered(rest.begin(), rest.begin() + 8);
        const std::span<const std::byte> payload = reader.read_bytes(size);
        covered.insert(covered.end(), payload.begin(), payload.end());
        if (crc32c(covered) != checksum)
        {
            return "section of kind " + std::to_string(kind) + " and " + std::to_string(size) +
                   " bytes is damaged: its checksum does not match";
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
            return "a section is out of order; the order is setup, " +
                   std::to_string(model_count_) + " models, then names, pieces and frames";
        }
        switch (kind)
        {
        case SectionKind::setup:
            has_setup_ = true;
            return parse_setup_section(payload);
        case SectionKind::model:
            return add_model(payload);
        case SectionKind::piece:
            return parse_piece(payload);
        case SectionKind::frames:
            return parse_frames(payload);
        case SectionKind::end:
            return parse_end(payload);
        case SectionKind::name:
            return parse_name(payload, recording_.setup_);
        }
        return std::nullopt;
    }

    Fault parse_setup_section(std::span<const std::byte> payload)
    {
        if (Fault fault = parse_setup(payload, recording_.setup_, model_count_))
        {
            return fault;
        }
        Arena measuring = Arena::measuring();
        const ModelPools pools(measuring, recording_.setup_.for_streamed_models, model_count_);
        static_cast<void>(pools);
        if (measuring.used() > pool_bytes_left_)
        {
            return "the pools of streamed models need more than " +
                   std::to_string(kMaxRecordedPoolBytes >> 20U) + " MiB, the most allowed";
        }
        pool_bytes_left_ -=
            recording_.setup_.for_streamed_models.base_cells > 0 ? measuring.used() : 0;
        return std::nullopt;
    }

    [[nodiscard]] bool is_streamed_model(std::size_t model) const
    {
        return recording_.setup_.models[model].base.empty();
    }

    Fault add_model(std::span<const std::byte> payload)
    {
        RecordedModel model;
        ModelCounts counts;
        if (Fault fault = parse_model(payload, recording_.setup_.for_streamed_models.base_cells > 0,
                                      model, counts, pool_bytes_left_))
        {
            return fault;
        }
        counts_.push_back(counts);
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
        const bool is_base = kind == ContentKind::base;
        const bool is_known = !reader.failed() && model < model_count_ &&
                              (kind == ContentKind::chunk ? number < counts_[model].chunks()
                               : kind == ContentKind::index_page
                                   ? number < counts_[model].index_pages()
                                   : is_base && is_streamed_model(model) && number == 0);
        if (!is_known)
        {
            return "a piece is neither a chunk or index page of a model of the recording, nor the "
                   "base mesh of a streamed model";
        }
        const std::size_t most = is_base ? kMaxRecordedBaseBytes : kMaxCodedChunkBytes;
        if (bytes.empty() || bytes.size() > most)
        {
            return "a piece has " + std::to_string(bytes.size()) + " bytes; 1 to " +
                   std::to_string(most) + " are allowed";
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
            recording_.failed_frames_ += decoder_->frame().has_hashes ? 0U : 1U;
            if (!fault && recording_.failed_frames_ > 1 &&
                recording_.failed_frames_ <= recording_.frame_count_)
            {
                fault = "follows a failed frame";
            }
            if (fault)
            {
                return "frame " + std::to_string(recording_.frame_count_) + " " + *fault;
            }
        }
        recording_.frames_.insert(recording_.frames_.end(), payload.begin(), payload.end());
        return std::nullopt;
    }

    /// Checks that the slots of all events exist, and that each arriving piece was recorded before.
    Fault check_pieces(const RecordedFrame& frame) const
    {
        std::uint64_t pages = recording_.setup_.for_streamed_models.pages;
        std::uint64_t index_pages = recording_.setup_.for_streamed_models.index_pages;
        for (const RecordedModel& model : recording_.setup_.models)
        {
            pages += model.capacities.pages;
            index_pages += model.capacities.index_pages;
        }
        for (const QueueEvent& event : frame.events)
        {
            const std::uint64_t slots = event.key.kind == ContentKind::chunk ? pages
                                        : event.key.kind == ContentKind::index_page
                                            ? index_pages
                                            : recording_.setup_.for_streamed_models.base_cells;
            if (event.slot >= slots)
            {
                return "refers to slot " + std::to_string(event.slot) + ", but the slot count is " +
                       std::to_string(slots);
            }
            if (event.kind != QueueEventKind::base_back &&
                recording_.piece(event.owner, event.key).empty())
            {
                return "takes piece " + std::to_string(event.key.number) + " of model " +
                       std::to_string(event.owner) +
                       " from the queues, but the piece is not in the recording before it";
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
        if (Fault fault = unless_whole(reader, "end"))
        {
            return fault;
        }
        if (frames != recording_.frame_count_ || pieces != recording_.pieces_.size())
        {
            return "the end section states " + counted(frames, "frame") + " and " +
                   counted(pieces, "piece") + ", but the file has " +
                   std::to_string(recording_.frame_count_) + " and " +
                   std::to_string(recording_.pieces_.size());
        }
        if (recording_.lost_from_ != kNoFrame && recording_.lost_from_ != frames)
        {
            return "the first lost frame is " + std::to_string(recording_.lost_from_) +
                   ", but must be " + std::to_string(frames);
        }
        has_end_ = true;
        return std::nullopt;
    }

    std::span<const std::byte> bytes_;
    std::string name_;
    std::size_t data_end_; ///< Start of the zeros at the end.
    std::size_t at_{0};
    Recording recording_;
    std::uint32_t model_count_{0};
    bool has_setup_{false};
    bool has_end_{false};
    std::size_t pool_bytes_left_{kMaxRecordedPoolBytes};
    std::vector<ModelCounts> counts_;
    std::optional<FrameDecoder> decoder_;
};

Result<Recording, Refusal> Recording::parse(std::span<const std::byte> bytes,
                                            const std::string& name)
{
    return RecordingParser(bytes, name).parse();
}

} // namespace tactus
