// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/model_fetcher.hpp"

#include "rt_core/spm/index_page.hpp"
#include "transport/base_fetch.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_link.hpp"
#include "transport/dds/edit_reader.hpp"
#include "transport/dds/header_fetch.hpp"
#include "transport/served_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace tactus::view
{

namespace
{

using Clock = std::chrono::steady_clock;

/// Time without a piece after which pieces are requested again.
constexpr std::chrono::milliseconds kAgain{100};
/// Maximum wait of bring().
constexpr std::chrono::milliseconds kPatience{1'500};
/// Maximum number of pieces in one request.
constexpr std::size_t kPiecesAtOnce = 256;
/// Name under which servers show the viewer if it has no keys.
constexpr const char* kName = "spm_view";

struct KeyOrder
{
    bool operator()(ContentKey a, ContentKey b) const noexcept
    {
        return std::pair(a.kind, a.number) < std::pair(b.kind, b.number);
    }
};

} // namespace

/// A model from a server. Received pieces are never removed, so memory grows to its file's size.
class FetchedModel final : public KnownModel, private PieceSink
{
public:
    /// `served.base` must be complete.
    FetchedModel(ServedModel served, const dds::Domain& domain, const dds::Catalogue& catalogue,
                 const Log& log)
        : served_(std::move(served)), header_(ModelHeader::parse(served_.header).value())
    {
        if (served_.edit_room > 0)
        {
            edits_ = std::make_unique<dds::EditReader>(
                domain, catalogue,
                std::vector<dds::EditReader::Model>{
                    {served_.name, served_.hash, header_, served_.edit_room}},
                log);
            edits_->follow(0, served_.server_epoch);
        }
        pieces_[{ContentKind::base, 0}] = std::move(served_.base);
    }

    [[nodiscard]] const std::string& name() const noexcept override { return served_.name; }
    [[nodiscard]] const ContentHash& hash() const noexcept override { return served_.hash; }
    [[nodiscard]] const ModelHeader& header() const noexcept override { return header_; }

    [[nodiscard]] std::optional<Refusal> bring(std::span<const ContentKey> keys) override
    {
        std::unique_lock lock(mutex_);
        for (const ContentKey key : keys)
        {
            want(key);
        }
        const auto is_resident = [&](ContentKey key) { return pieces_.contains(key); };
        if (came_.wait_for(lock, kPatience, [&] { return std::ranges::all_of(keys, is_resident); }))
        {
            return std::nullopt;
        }
        const auto here = std::ranges::count_if(keys, is_resident);
        return Refusal{fmt::format(
            "{} of {} pieces of the model {} have arrived from its server{}", here, keys.size(),
            served_.name, is_gone_ ? ", which disconnected" : "; the others are requested")};
    }
    [[nodiscard]] Result<Done, Refusal> read(ContentKey key, std::vector<std::byte>& coded) override
    {
        const std::lock_guard lock(mutex_);
        const auto found = pieces_.find(key);
        if (found == pieces_.end())
        {
            return Refusal{fmt::format("the model {} is incomplete", served_.name)};
        }
        coded = found->second;
        return Done{};
    }

    [[nodiscard]] std::shared_ptr<const EditState> edits() const override
    {
        const std::lock_guard lock(mutex_);
        return edits_ != nullptr && edit_revision_ > 0
                   ? std::make_shared<const EditState>(edits_->state(0))
                   : last_edits_;
    }
    [[nodiscard]] std::uint32_t edit_revision() const override
    {
        const std::lock_guard lock(mutex_);
        return edit_revision_;
    }

    /// Polls the link and requests wanted pieces. Only the fetcher's thread calls it and
    /// leave_server().
    void step()
    {
        served_.link->poll(*this);
        const std::lock_guard lock(mutex_);
        take_edits();
        is_gone_ = served_.link->state() == LinkState::server_gone;
        const auto now = Clock::now();
        const bool is_stuck =
            now - progress_ >= kAgain || served_.link->session() != session_ || asked_.empty();
        if (wanted_.empty() || is_gone_ || !is_stuck)
        {
            return;
        }
        session_ = served_.link->session();
        progress_ = now;
        asked_.assign(wanted_.begin(), wanted_.end());
        asked_.resize(std::min(asked_.size(), kPiecesAtOnce));
        served_.link->request(asked_, ++generation_);
    }
    [[nodiscard]] bool is_busy() const
    {
        const std::lock_guard lock(mutex_);
        return !wanted_.empty() && !is_gone_;
    }
    /// Deletes the link; pieces that are missing then stay missing.
    void leave_server()
    {
        served_.link.reset();
        const std::lock_guard lock(mutex_);
        if (edits_ != nullptr) // Its surface stays; the catalogue does not.
        {
            last_edits_ =
                edit_revision_ > 0 ? std::make_shared<const EditState>(edits_->state(0)) : nullptr;
            edits_.reset();
        }
        is_gone_ = true;
    }

private:
    /// Takes the server's edits. The mutex must be held.
    void take_edits()
    {
        if (edits_ == nullptr)
        {
            return;
        }
        edits_->poll();
        while (edits_->next(0) != nullptr)
        {
            edits_->pop(0);
        }
        edit_revision_ = edits_->state(0).revision();
    }

    using Entries = std::array<ChunkEntry, kChunksPerIndexPage>;

    /// Marks a piece as wanted; for a chunk without its index page, which has its hash, that page
    /// first.
    void want(ContentKey key)
    {
        if (!pieces_.contains(key))
        {
            const ContentKey index{ContentKind::index_page, key.number >> kChunksPerIndexPageLog2};
            const bool is_ready = key.kind != ContentKind::chunk || pieces_.contains(index);
            wanted_.insert(is_ready ? key : index);
            if (!is_ready)
            {
                waiting_.insert(key);
            }
        }
    }

    void receive(ContentKey key, std::span<const std::byte> bytes) override
    {
        const std::lock_guard lock(mutex_);
        if (!wanted_.contains(key))
        {
            return;
        }
        if (!is_sound(key, bytes))
        {
            static_cast<void>(served_.link->distrust(key));
            return;
        }
        pieces_[key].assign(bytes.begin(), bytes.end());
        wanted_.erase(key);
        std::erase(asked_, key);
        progress_ = Clock::now();
        if (key.kind == ContentKind::index_page)
        {
            for (const ContentKey chunk : std::exchange(waiting_, {}))
            {
                want(chunk);
            }
        }
        came_.notify_all();
    }

    [[nodiscard]] bool is_sound(ContentKey key, std::span<const std::byte> bytes)
    {
        if (key.kind == ContentKind::index_page)
        {
            IndexPage page;
            return content_hash(bytes) == header_.index_entry({key.number}).hash &&
                   parse_index_page(bytes, header_.counts(), {key.number}, page,
                                    entries_[key.number])
                       .has_value();
        }
        const ChunkEntry& entry =
            entries_.at(key.number >> kChunksPerIndexPageLog2)[key.number % kChunksPerIndexPage];
        return bytes.size() == entry.coded_bytes && content_hash(bytes) == entry.hash;
    }

    ServedModel served_; ///< Model; only the fetcher's thread uses its link.
    ModelHeader header_;
    std::uint64_t session_{0};
    std::uint32_t generation_{0};
    Clock::time_point progress_{};

    mutable std::mutex mutex_; ///< Protects the members below.
    std::condition_variable came_;
    bool is_gone_{false};
    std::map<ContentKey, std::vector<std::byte>, KeyOrder> pieces_;
    std::map<std::uint32_t, Entries> entries_; ///< Sizes and hashes of chunks, by index page.
    std::set<ContentKey, KeyOrder> wanted_;    ///< Missing pieces that may be requested.
    std::set<ContentKey, KeyOrder> waiting_;   ///< Wanted chunks without their index page.
    std::unique_ptr<dds::EditReader> edits_;   ///< Null if the model can't be edited.
    std::uint32_t edit_revision_{0};
    std::shared_ptr<const EditState> last_edits_; ///< Surface when the server was left.
    std::vector<ContentKey> asked_; ///< Pieces of the last request that have not arrived.
};

/// State of the fetch of one model's header and base mesh.
struct ModelFetcher::Search
{
    Search(dds::PieceExchange& exchange, dds::Catalogue& catalogue, const ContentHash& hash)
        : header(exchange, catalogue, {.name = "", .hash = hash})
    {
    }

    dds::HeaderSearch header; ///< Search for the header, until `served` is set.
    bool is_announced{false}; ///< True once the shelf knows that the model is coming.
    std::string objection;    ///< Objection of `header` that was logged last.
    ServedModel served;       ///< Model with header, while its base mesh is fetched.
    std::unique_ptr<BaseFetch> base;
    std::shared_ptr<FetchedModel> model; ///< Model on the shelf; null before.
};

Result<std::unique_ptr<ModelFetcher>, Refusal> ModelFetcher::create(const dds::Domain& domain,
                                                                    ModelShelf& shelf, Log log)
{
    auto catalogue = dds::Catalogue::create(domain, log);
    if (!catalogue)
    {
        return catalogue.error();
    }
    std::unique_ptr<ModelFetcher> fetcher(
        new ModelFetcher(domain, std::move(catalogue).value(), shelf, std::move(log)));
    auto exchange = dds::PieceExchange::create(
        domain, fetcher->catalogue_, domain.certificate().empty() ? kName : domain.certificate());
    if (!exchange)
    {
        return exchange.error();
    }
    fetcher->exchange_ = std::move(exchange).value();
    return fetcher;
}

ModelFetcher::ModelFetcher(const dds::Domain& domain, dds::Catalogue catalogue, ModelShelf& shelf,
                           Log log)
    : domain_(domain), catalogue_(std::move(catalogue)), shelf_(shelf), log_(std::move(log))
{
}

ModelFetcher::~ModelFetcher()
{
    for (auto& [hash, search] : searches_)
    {
        if (search->model != nullptr) // The shelf still uses the model.
        {
            search->model->leave_server();
        }
    }
}

void ModelFetcher::look_for(const ContentHash& hash)
{
    if (!searches_.contains(hash) && searches_.size() < kMaxModels && !shelf_.has(hash))
    {
        searches_[hash] = std::make_unique<Search>(*exchange_, catalogue_, hash);
    }
}

void ModelFetcher::step()
{
    exchange_->step();
    for (auto& [hash, search] : searches_)
    {
        step(hash, *search);
    }
}

bool ModelFetcher::is_busy() const
{
    return std::ranges::any_of(searches_,
                               [](const auto& each)
                               {
                                   const Search& search = *each.second;
                                   return search.model != nullptr ? search.model->is_busy()
                                                                  : search.is_announced;
                               });
}

void ModelFetcher::step(const ContentHash& hash, Search& search)
{
    if (search.model != nullptr)
    {
        search.model->step();
    }
    else if (search.base != nullptr)
    {
        const auto state = search.base->step();
        if (state == BaseFetch::State::done)
        {
            search.base.reset();
            search.model =
                std::make_shared<FetchedModel>(std::move(search.served), domain_, catalogue_, log_);
            shelf_.add(search.model);
        }
        else if (state == BaseFetch::State::refused)
        {
            log_(
                fmt::format("model '{}' has a base mesh that does not match the hash in its header",
                            search.served.name));
            search.base.reset();
            search.served = {};
            search.header.refuse(search.header.offer());
        }
    }
    else
    {
        take_header(hash, search);
    }
}

void ModelFetcher::take_header(const ContentHash& hash, Search& search)
{
    using State = dds::HeaderSearch::State;
    const State state = search.header.step();
    if (state == State::under_way && !search.is_announced)
    {
        search.is_announced = true;
        shelf_.announce(hash);
    }
    else if (state == State::done)
    {
        search.served.name = search.header.offer().name;
        search.served.hash = hash;
        search.served.server_epoch = search.header.offer().server_epoch;
        search.served.edit_room = search.header.offer().edit_room;
        search.served.header = std::move(search.header.header());
        search.served.link =
            std::make_unique<dds::DdsLink>(*exchange_, catalogue_, search.header.offer(), log_);
        search.base = std::make_unique<BaseFetch>(search.served);
    }
    else if (state == State::refused)
    {
        search.is_announced = false;
        if (std::exchange(search.objection, search.header.objection()) != search.objection)
        {
            log_(fmt::format("model '{}' {}", search.header.offer().name, search.objection));
        }
    }
}

} // namespace tactus::view
