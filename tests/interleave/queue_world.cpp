// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/queue_world.hpp"

#include "transport/served_model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <type_traits>

namespace tactus::interleave
{

namespace
{

constexpr std::int64_t kStepNs = 1'000'000;
constexpr ChunkLoaderOptions kOptions{.open_requests = 3};
constexpr std::array<ChunkId, 3> kAll{ChunkId{0}, ChunkId{1}, ChunkId{2}};

} // namespace

const char* name_of(Verb verb)
{
    constexpr std::array<const char*, kVerbs> names{"adopt",
                                                    "want_a",
                                                    "want_b",
                                                    "want_c",
                                                    "want_all",
                                                    "evict",
                                                    "pin",
                                                    "unpin",
                                                    "be_late",
                                                    "step",
                                                    "step_holding",
                                                    "step_losing",
                                                    "step_damaging",
                                                    "step_reversing",
                                                    "step_repeating",
                                                    "change_server",
                                                    "step_frame_at_request",
                                                    "step_frame_at_piece",
                                                    "step_frame_at_hand_over"};
    return names.at(static_cast<std::size_t>(verb));
}

QueueWorld::QueueWorld(const Truth& truth, std::span<std::byte> memory)
    : truth_(truth)
    , arena_(memory)
    , slots_(PageSlots::take(arena_, truth.model.counts, kPages, 1))
    , pool_(arena_, kPages, 1, 1)
    , pages_(pool_.pages, 0, slots_)
    , link_pool_(arena_, kPages)
    , linker_(link_pool_, 0, truth.header, slots_)
    , cache_(pool_, {}, truth.header, slots_, pages_, portable_kernels())
    , link_(truth.model)
    , ledger_(truth, slots_, pages_)
    , copies_(*this)
    , chunk_loader_(arena_, slots_, pool_.queues, {}, kOptions)
{
    chunk_loader_.add(truth.header, linker_, link_, "world");
    const auto loaded = load_base_mesh(truth.model.base, truth.header, slots_.base);
    TACTUS_ASSERT(loaded.has_value());
    chunk_loader_.copy_pieces_to(&copies_);
    FrameVariant every_frame;
    // A frame that wants chunks searches for all of them every time.
    every_frame.keeps_searches = false;
    cache_.set_variant(every_frame);
}

void QueueWorld::Copies::receive(ContentKey key, std::span<const std::byte> bytes)
{
    if (runs_frame)
    {
        world.frame_in_the_middle();
    }
    world.ledger_.receive(key, bytes);
}

std::vector<Verb> QueueWorld::offered() const
{
    std::vector<Verb> verbs{Verb::want_a, Verb::want_b, Verb::want_c, Verb::want_all,
                            Verb::be_late};
    const bool has_pages = pages_.used() > 0;
    const auto add_if = [&](bool makes_sense, Verb verb)
    {
        if (makes_sense)
        {
            verbs.push_back(verb);
        }
    };
    add_if(pool_.queues.arrived.size() > 0, Verb::adopt);
    add_if(has_pages, Verb::evict);
    add_if(page_to_pin() < kPages, Verb::pin);
    bool has_pinned = false;
    for (std::uint32_t slot = 0; slot < kPages; ++slot)
    {
        has_pinned = has_pinned || pages_.meta(slot).refined != 0;
    }
    add_if(has_pinned, Verb::unpin);
    for (auto verb = static_cast<std::uint32_t>(Verb::step); verb < kVerbs; ++verb)
    {
        verbs.push_back(static_cast<Verb>(verb));
    }
    return verbs;
}

bool QueueWorld::apply(Verb verb)
{
    bool is_new = true;
    had_losses_ = had_losses_ || verb == Verb::be_late || verb == Verb::step_losing ||
                  verb == Verb::step_damaging || verb == Verb::change_server;
    switch (verb)
    {
    case Verb::adopt:
        adopt();
        break;
    case Verb::want_a:
        want(std::span(kAll).first(1));
        break;
    case Verb::want_b:
        want(std::span(kAll).subspan(1, 1));
        break;
    case Verb::want_c:
        want(std::span(kAll).subspan(2, 1));
        break;
    case Verb::want_all:
        want(kAll);
        break;
    case Verb::evict:
        evict();
        break;
    case Verb::pin:
        pin();
        break;
    case Verb::unpin:
        unpin();
        break;
    case Verb::be_late:
        want({}, kRequestTimeoutFrames + 1);
        break;
    case Verb::change_server:
        link_.state() == LinkState::connected ? link_.lose_server() : link_.regain_server();
        break;
    default:
        is_new = step(verb);
        break;
    }
    ledger_.check(chunk_loader_, pool_.queues, cache_);
    return is_new;
}

bool QueueWorld::step(Verb verb)
{
    using Enum = std::underlying_type_t<Verb>;
    const auto beyond = static_cast<Enum>(verb) - static_cast<Enum>(Verb::step);
    link_.weather = verb < Verb::change_server ? static_cast<Weather>(beyond) : Weather::delivers;
    const auto frame = [this] { frame_in_the_middle(); };
    link_.at_request = verb == Verb::step_frame_at_request ? frame : std::function<void()>{};
    link_.before_piece = verb == Verb::step_frame_at_piece ? frame : std::function<void()>{};
    copies_.runs_frame = verb == Verb::step_frame_at_hand_over;
    had_middle_ = false;
    now_ns_ += kStepNs;
    ledger_.begin_step();
    chunk_loader_.step(now_ns_);
    return verb == Verb::step ||
           (verb < Verb::change_server ? link_.was_weather_felt() : had_middle_);
}

void QueueWorld::adopt()
{
    work_ = {};
    pool_.adopt_arrivals(Budgets{}.pages, frame_, work_);
    ledger_.adopted(pool_.taken());
}

/// Frame that adopts nothing: arrived pages may wait for the next one, even those of high priority.
void QueueWorld::want(std::span<const ChunkId> chunks, std::uint32_t frames)
{
    frame_ += frames;
    work_ = {};
    pool_.adopt_arrivals(0, frame_, work_); // Updates the queues' capacity for requests.
    std::vector<RankedRegion> regions;
    for (const ChunkId chunk : chunks) // See TinyModelSpec::boxes_in_a_row.
    {
        const double x =
            (static_cast<double>(chunk.value) + 0.5) / static_cast<double>(kAll.size());
        const double extent_m = 1'000.0 * static_cast<double>(truth_.header.quantum_m());
        regions.push_back({{}, Vec3(x * extent_m, 0.0, 0.0), 0.01 * extent_m, 0});
    }
    FrameFault faults{};
    cache_.request_missing(regions, {}, frame_, work_, faults);
    ledger_.find_freed();
}

void QueueWorld::evict()
{
    cache_.evict_unpinned(work_);
    ledger_.find_freed();
}

void QueueWorld::frame_in_the_middle()
{
    had_middle_ = true;
    adopt();
    evict();
    want(kAll);
}

std::uint32_t QueueWorld::page_to_pin() const
{
    std::uint32_t slot = 0;
    while (slot < kPages && (pages_.meta(slot).linked == 0 || pages_.meta(slot).refined != 0))
    {
        ++slot;
    }
    return slot;
}

void QueueWorld::pin()
{
    const PageTable::Meta& meta = pages_.meta(page_to_pin());
    const auto place = static_cast<std::uint32_t>(std::countr_zero(meta.linked));
    pages_.set_refined({(meta.chunk.value << kRecordsPerChunkLog2) + place}, true);
}

void QueueWorld::unpin()
{
    for (std::uint32_t slot = 0; slot < kPages; ++slot)
    {
        const PageTable::Meta& meta = pages_.meta(slot);
        if (meta.refined != 0)
        {
            const auto place = static_cast<std::uint32_t>(std::countr_zero(meta.refined));
            pages_.set_refined({(meta.chunk.value << kRecordsPerChunkLog2) + place}, false);
        }
    }
}

bool QueueWorld::is_settled() const
{
    return ledger_.told({0}) == truth_.linkable[0] && ledger_.told({1}) == truth_.linkable[1] &&
           cache_.requests_under_way() == 0 && pool_.queues.arrived.size() == 0 &&
           pool_.queues.freed.size() == 0 && pool_.queues.wanted.size() == 0 &&
           chunk_loader_.free_pages() + pages_.used() == kPages;
}

/// True if a request may have to expire before it can be repeated.
bool QueueWorld::was_anything_lost() const
{
    const ChunkLoaderCounters& counters = chunk_loader_.counters();
    return had_losses_ || counters.forgotten + counters.dropped_no_slot > 0;
}

void QueueWorld::settle()
{
    constexpr int kFrames = 24;
    unpin();
    if (link_.state() == LinkState::server_gone)
    {
        static_cast<void>(apply(Verb::change_server));
    }
    for (int i = 0; i < kFrames && !ledger_.has_failed() && !is_settled(); ++i)
    {
        adopt();
        want(std::span(kAll).first(kPages), was_anything_lost() ? kRequestTimeoutFrames + 1 : 1);
        static_cast<void>(apply(Verb::step));
    }
    ledger_.require(is_settled(), "a request is lost: what is wanted does not come");
}

} // namespace tactus::interleave
