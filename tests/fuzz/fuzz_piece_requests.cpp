// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a sequence of parts (InputParts), each a request of one controller as Cyclone hands
/// it to a server, in the bytes of sample_script.hpp. If bit 0 of a part's control byte is set, the
/// server then sends once. There is no network. Sent pieces were requested, have the bytes of their
/// model, and are within the credit.
#include "tests/fuzz/input_parts.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/sample_script.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/piece_requests.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace tactus::fuzz
{

namespace
{

/// Models of a server, and the bytes of their pieces by the maker of the models.
class ServedModels
{
public:
    ServedModels()
    {
        models_.push_back(test::make_tiny_model({}));
        models_.push_back(test::make_tiny_model({.seed = 2, .records = 70}));
        for (std::size_t i = 0; i < models_.size(); ++i)
        {
            files_[i].replace(models_[i].file);
            auto store = ModelStore::open(files_[i].path());
            require(static_cast<bool>(store), "a tiny model can be opened");
            auto pieces = dds::ModelPieces::create({"tiny", std::move(store).value(), 0});
            require(static_cast<bool>(pieces), "a tiny model can be published");
            pieces_.push_back(std::move(pieces).value());
        }
    }

    [[nodiscard]] std::span<const dds::ModelPieces> pieces() const noexcept { return pieces_; }
    /// Bytes of a piece; empty if the model lacks it. Header and base mesh have one part.
    [[nodiscard]] std::span<const std::byte> bytes_of(std::size_t model, std::uint32_t kind,
                                                      std::uint32_t number) const
    {
        const test::TinyModel& made = models_[model];
        switch (kind)
        {
        case 0:
            return number == 0 ? made.base : std::span<const std::byte>();
        case 1:
            return piece_of(made.index_pages, number);
        case 2:
            return piece_of(made.chunks, number);
        case 3:
            return number == 0 ? made.header : std::span<const std::byte>();
        default:
            return {};
        }
    }
    /// Number of the model with this hash.
    [[nodiscard]] std::size_t model_of(const ContentHash& hash) const
    {
        const auto found = std::ranges::find(
            pieces_, hash, [](const dds::ModelPieces& pieces) { return pieces.store().hash(); });
        require(found != pieces_.end(), "a sent piece is of a served model");
        return static_cast<std::size_t>(found - pieces_.begin());
    }

private:
    [[nodiscard]] static std::span<const std::byte>
    piece_of(const std::vector<std::vector<std::byte>>& all, std::uint32_t number)
    {
        return number < all.size() ? all[number] : std::span<const std::byte>();
    }

    std::array<ScratchFile, 2> files_{ScratchFile("first.spm"), ScratchFile("second.spm")};
    std::vector<test::TinyModel> models_;
    std::vector<dds::ModelPieces> pieces_;
};

/// One controller, and the laws of its answers.
class Conversation
{
public:
    Conversation(const ServedModels& models, std::uint64_t seen) : models_(models), requests_(seen)
    {
    }

    void take(const tactus_v5_Wanted& wanted)
    {
        seen_ = std::max<std::uint64_t>(seen_, std::min(wanted.seen, requests_.sent()));
        granted_ = std::max<std::uint64_t>(granted_, wanted.granted);
        requests_.set_credit({wanted.seen, wanted.granted, wanted.received});
        require(requests_.lost() <= requests_.sent(), "only sent pieces can be lost");
        std::uint32_t unknown = 0;
        for (const auto& name : std::span(wanted.pieces._buffer, wanted.pieces._length))
        {
            const bool is_known = name.model < models_.pieces().size() &&
                                  !models_.bytes_of(name.model, name.kind, name.number).empty();
            unknown += is_known ? 0U : 1U;
            if (is_known)
            {
                wanted_.insert({name.model, name.kind, name.number});
            }
        }
        require(requests_.take(wanted, models_.pieces()) == unknown,
                "exactly the unknown pieces are refused");
        require(!requests_.has_work() || !wanted_.empty(), "work is a request");
    }

    /// Sends one sample, as Subscription does.
    void send()
    {
        if (!requests_.has_work())
        {
            return;
        }
        const std::uint64_t pieces = requests_.fill(models_.pieces(), room_, log_);
        require(pieces > 0, "work fills a sample");
        require(room_.payload.size() <= dds::kPayloadBytes, "a payload fits its bound");
        dds::PieceReader reader(room_.payload);
        std::uint64_t read = 0;
        for (auto piece = reader.next(); piece; piece = reader.next())
        {
            const std::size_t model = models_.model_of(piece->key.model);
            require(wanted_.erase({model, piece->key.kind, piece->key.number}) == 1,
                    "a sent piece was requested");
            require(std::ranges::equal(piece->bytes,
                                       models_.bytes_of(model, piece->key.kind, piece->key.number)),
                    "a sent piece has the bytes of its model");
            ++read;
        }
        require(!reader.is_broken() && read == pieces, "a payload is whole pieces");
        requests_.on_sent(pieces);
        require(requests_.sent() <= granted_ && requests_.sent() - seen_ <= dds::kCreditPieces,
                "pieces are sent within the credit");
        ++accepted_inputs;
    }

private:
    const ServedModels& models_;
    dds::PieceRequests requests_;
    dds::PieceBuffers room_;
    RateLimitedLog log_{[](const std::string&) { require(false, "all pieces can be read"); }};
    /// Requested pieces that were not sent yet: model, kind, number.
    std::set<std::tuple<std::size_t, std::uint32_t, std::uint32_t>> wanted_;
    std::uint64_t seen_{0};
    std::uint64_t granted_{0};
};

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus::fuzz;
    constexpr unsigned kSends = 1;
    static const ServedModels models;
    InputParts parts(data, size);
    std::optional<Conversation> conversation;
    while (!parts.is_at_end())
    {
        const InputParts::Part part = parts.part();
        SampleReader reader(part.bytes);
        const auto wanted = reader.read_sample<tactus_v5_Wanted>();
        if (!conversation)
        {
            conversation.emplace(models, wanted.seen);
        }
        conversation->take(wanted);
        if ((part.control & kSends) != 0)
        {
            conversation->send();
        }
    }
    return 0;
}
