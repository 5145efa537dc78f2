// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_slots.hpp"
#include "transport/chunk_link.hpp"
#include "transport/log.hpp"
#include "transport/part_intake.hpp"
#include "transport/slot_bank.hpp"
#include "transport/waiting_times.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus
{

/// Counts of the transport thread's work for one model since the start.
struct ChunkLoaderCounters
{
    std::uint64_t pieces{0};      ///< Pieces received, accepted or not.
    std::uint64_t coded_bytes{0}; ///< Bytes of the received pieces, without the link's framing.
    std::uint64_t delivered{0};   ///< Pieces passed to the haptic thread.
    std::uint64_t requests{0};    ///< Requests taken from the haptic thread.
    /// Requests sent to the link again, after the haptic thread's timeout or a change of server.
    std::uint64_t asked_again{0};

    /// Pieces refused for a wrong hash: damaged, forged, or sent under another key.
    std::uint64_t refused_hash{0};
    /// Pieces with the right hash and a content that cannot be parsed: a fault of the model.
    std::uint64_t refused_content{0};
    /// Pieces without an open request, for example duplicates and late ones.
    std::uint64_t dropped_unasked{0};
    /// Pieces dropped because no slot was free: the haptic thread has all slots.
    std::uint64_t dropped_no_slot{0};
    /// Chunks dropped because their index page, which has their hash, is not resident.
    std::uint64_t dropped_no_index{0};
    std::uint64_t forgotten{0}; ///< Requests dropped because `open_requests` were open.
    /// Requests unanswered for a second with a server present (RequestClock), and base meshes.
    std::uint64_t overdue{0};
    std::uint64_t overdue_came{0}; ///< Overdue pieces that arrived in the end.

    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_hash + refused_content; }
};

/// Limits and times of a chunk loader.
struct ChunkLoaderOptions
{
    /// Maximum number of open requests, 64 B each; above 0 (asserted).
    std::uint32_t open_requests{SlotQueues::kOpenRequests};
    /// Time after its last request at which a piece is no longer wanted, in ns. The haptic thread
    /// repeats a request after kRequestTimeoutFrames, or twice that. Also the time without a part
    /// after which the fetch of a base mesh ends.
    std::int64_t forgotten_ns{1'000'000'000};
};

/// Work of the transport thread: takes requests from the haptic thread and sends them to each
/// model's link; verifies arriving pieces, parses each into a free slot, links its records and
/// hands the slot over. Has no thread of its own: call step() on one thread.
///
/// Trust: the hash of an index page is in the header, and that of a chunk in its index page. A slot
/// thus holds only data by the header's author. A refused piece changes nothing but counters; its
/// slot stays free.
///
/// A record may depend on a record of a page that arrives later. Once that page links it, the
/// haptic thread is sent all linked records of the earlier page, as soon as the queue has room.
///
/// A piece that does not arrive within a second is logged and counted, and so is its later arrival.
///
/// The base mesh of a streamed model arrives in parts. The whole is checked against the hash in the
/// header and parsed into the cells (SlotQueues) that the request lent. It is handed over before
/// any page of the model. The haptic thread frees it after all those pages. If no part arrives for
/// `forgotten_ns`, the cells are returned; the parts are kept for the next request, which may reach
/// another server. If the base mesh is refused, its cells are returned and its parts are dropped.
///
/// Nothing is allocated after the last add(), except for base meshes in transit, by links and by
/// the log.
class ChunkLoader
{
public:
    /// Takes all slots, of all models, as free. Their memory and `queues` must outlive the
    /// ChunkLoader.
    ChunkLoader(Arena& arena, const PageSlots& slots, SlotQueues& queues, Log log,
                const ChunkLoaderOptions& options = {});

    /// Bytes that the constructor takes from the arena.
    [[nodiscard]] static std::size_t
    required_bytes(std::size_t pages, std::size_t index_pages,
                   const ChunkLoaderOptions& options = {}) noexcept;

    /// Adds the model numbered linker.owner(), which must equal model_count() (asserted). All
    /// arguments must outlive the ChunkLoader. `name` begins the model's log lines. A linker
    /// without a base mesh belongs to a streamed model: its mesh is fetched on request.
    void add(const ModelHeader& header, Linker& linker, ChunkLink& link, std::string name);

    /// Runs one round: takes freed slots and requests, sends requests to the links, takes arrivals
    /// and pushes link updates. `now_ns` is from one monotonic clock. The cost grows with the
    /// arrivals; a link to a file waits for its disk.
    void step(std::int64_t now_ns);

    /// Passes each verified piece of the model, in coded form, to `copies` too, right before the
    /// haptic thread gets it; null ends that. `copies` must outlive the ChunkLoader. `model` must
    /// be below model_count(), also in the functions below.
    void copy_pieces_to(PieceSink* copies, std::uint32_t model = 0) noexcept
    {
        sides_[model]->copies = copies;
    }

    [[nodiscard]] std::uint32_t model_count() const noexcept
    {
        return static_cast<std::uint32_t>(sides_.size());
    }
    [[nodiscard]] const ChunkLoaderCounters& counters(std::uint32_t model = 0) const noexcept
    {
        return sides_[model]->counters;
    }
    /// Times from a request for a piece until the piece was handed to the haptic thread.
    [[nodiscard]] const WaitingTimes& waiting_times(std::uint32_t model = 0) const noexcept
    {
        return sides_[model]->waiting_times;
    }
    /// True if a piece of the model is overdue (RequestClock) and still wanted.
    [[nodiscard]] bool is_starved(std::uint32_t model = 0) const noexcept;
    [[nodiscard]] std::size_t open_requests() const noexcept { return open_count_; }
    /// Appends the chunks of the model that have an open request, in any order.
    void add_requested_chunks(std::uint32_t model, std::vector<ChunkId>& chunks) const;
    [[nodiscard]] std::size_t free_pages() const noexcept { return bank_.free_pages(); }
    [[nodiscard]] std::size_t free_index_pages() const noexcept { return bank_.free_index_pages(); }

private:
    /// State of one model.
    struct Side final : PieceSink
    {
        Side(ChunkLoader& chunk_loader, const ModelHeader& model_header, Linker& model_linker,
             ChunkLink& model_link, std::string model_name)
            : owner(chunk_loader)
            , header(model_header)
            , counts(model_header.counts())
            , linker(model_linker)
            , link(model_link)
            , name(std::move(model_name))
            , session(model_link.session())
        {
        }
        void receive(ContentKey key, std::span<const std::byte> bytes) override
        {
            owner.receive(*this, key, bytes);
        }

        ChunkLoader& owner;
        const ModelHeader& header;
        ModelCounts counts;
        Linker& linker;
        ChunkLink& link;
        std::string name;
        std::uint64_t session;
        std::size_t unasked{0}; ///< Open requests not yet sent to the link.
        std::size_t overdue{0}; ///< Open requests that are overdue.
        /// First cell lent for the base mesh that is being fetched; none if no mesh is wanted.
        std::optional<std::uint32_t> base_cell;
        PartIntake base;
        bool is_base_asked{false};
        /// Time when the mesh was first requested or when its last part arrived.
        std::int64_t base_progress_ns{0};
        PieceSink* copies{nullptr};
        ChunkLoaderCounters counters;
        WaitingTimes waiting_times;
    };
    struct OpenRequest
    {
        Side* side{nullptr};
        ContentKey key;
        std::uint32_t generation{0};
        bool is_asked{false};
        RequestClock clock;
    };

    void receive(Side& side, ContentKey key, std::span<const std::byte> bytes);
    void want_base(Side& side, const PieceRequest& request);
    void bring_base(Side& side);
    void adopt_base(Side& side);
    void give_cells_back(Side& side);
    void hand_over_cells(Side& side, QueueEventKind kind);
    void take_requests(std::size_t count);
    void open_request(const PieceRequest& request);
    void forget_oldest_generation();
    void request_again(OpenRequest& open);
    void ask_again(OpenRequest& open);
    void ask(Side& side);
    void adopt_index_page(Side& side, IndexPageId page, std::span<const std::byte> bytes);
    void adopt_chunk(Side& side, ChunkId chunk, std::span<const std::byte> bytes);
    void hand_over(Side& side, ContentKey key, std::uint32_t slot, std::uint64_t linked,
                   std::span<const std::byte> bytes);
    void push_link_updates(Side& side);
    void refuse(const Side& side, std::uint64_t& counter, ContentKey key, const char* reason);
    void tell(const Side& side, ContentKey key, std::string_view what, std::string_view more = "");
    [[nodiscard]] OpenRequest* find_open(const Side& side, ContentKey key) noexcept;
    void close_request(const Side& side, ContentKey key) noexcept;
    void remove(OpenRequest& open) noexcept;
    [[nodiscard]] bool is_resident(const Side& side, ContentKey key) const noexcept;

    PageSlots slots_;
    SlotQueues& queues_;
    SlotBank bank_;
    RateLimitedLog log_;
    std::span<OpenRequest> open_; ///< Storage of open requests; the first `open_count_` are in use.
    std::size_t open_count_{0};
    std::span<ContentKey> batch_;
    std::int64_t forgotten_ns_;
    std::uint32_t newest_generation_{0};
    std::int64_t now_ns_{0};
    std::vector<std::unique_ptr<Side>> sides_; ///< Models by owner number.
};

} // namespace tactus
