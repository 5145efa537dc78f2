// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Requests of a cache, frame by frame, compared with a search of all boxes of the model.

#include "rt_core/cache/chunk_cache.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <ostream>
#include <set>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kModelChunks = 11 * 64 + 13; ///< The last of twelve index pages is short.
constexpr std::uint32_t kModelPages = 12;
constexpr double kModelQuantum = 0x1p-10;
constexpr double kModelSide = 100'000.0; ///< Side of the model in quanta.
constexpr std::uint32_t kMovingTools = 3;

/// Moving tool in the world, in quanta of an unscaled model.
struct MovingTool
{
    Vec3 center{0.0, 0.0, 0.0};
    Vec3 velocity{0.0, 0.0, 0.0};
    double radius{1.0};
    PriorityClass of{PriorityClass::touching};
    bool looks_ahead{true};
};

/// Position of the model.
struct MovingModel
{
    Vec3 at{0.0, 0.0, 0.0};
    Vec3 velocity{0.0, 0.0, 0.0};
    double scale{1.0};
};

struct SearchCase
{
    const char* name;
    std::uint32_t page_slots{kModelChunks};
    std::uint32_t index_slots{kModelPages};
    std::uint32_t lost_in_100{0}; ///< Percentage of requests without an answer.
    Budgets budgets;
};

std::ostream& operator<<(std::ostream& stream, const SearchCase& test_case)
{
    return stream << test_case.name;
}

double distance_to(const Vec3& place, const std::array<Vec3, 2>& box)
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double nearest = std::clamp(place[axis], box[0][axis], box[1][axis]);
        sum += (place[axis] - nearest) * (place[axis] - nearest);
    }
    return std::sqrt(sum);
}

using AskedKeys = std::vector<ContentKey>;

/// Model of random boxes with moving tools and the transport thread's part.
class ChunkSearchRig
{
public:
    ChunkSearchRig(const SearchCase& test_case, std::uint64_t seed)
        : case_(test_case), random_(Random::seeded(seed)), parts_(sound_header(kModelChunks * 64))
    {
        make_boxes();
        bytes_ = parts_.write();
        const ModelHeader header = parsed(bytes_);
        slots_ = PageSlots::take(arena_, header.counts(), case_.page_slots, case_.index_slots);
        pool_.emplace(arena_, case_.page_slots, case_.index_slots, 1);
        pool_->set_period(10'000'000); // A request is lost after 25 frames.
        table_.emplace(pool_->pages, 0, slots_);
        sut.emplace(*pool_, ChunkCache::Kept{}, header, slots_, *table_, best_kernels());
        for (std::uint32_t slot = 0; slot < case_.page_slots; ++slot)
        {
            free_chunks_.push_back(slot);
        }
        for (std::uint32_t slot = 0; slot < case_.index_slots; ++slot)
        {
            free_index_.push_back(slot);
        }
        for (MovingTool& tool : tools_)
        {
            renew(tool);
        }
    }

    /// One frame; returns its requests.
    AskedKeys step(bool moves)
    {
        ++frame;
        if (moves)
        {
            move();
        }
        deliver();
        if (moves && random_.one_in(20))
        {
            WorkCounters dropped;
            sut->evict_unpinned(dropped);
        }
        const RegionRanking regions = spheres();
        work = {};
        FrameFault faults{};
        pool_->adopt_arrivals(1'000, frame, work);
        before_ = resident_chunks();
        sut->request_missing(regions.view(), case_.budgets, frame, work, faults);
        take_freed();
        return take_requests();
    }

    /// Least level of each met chunk, of resident index pages or of all.
    [[nodiscard]] std::map<std::uint32_t, std::uint32_t> met(bool of_all = false) const
    {
        std::map<std::uint32_t, std::uint32_t> levels;
        for (std::uint32_t chunk = 0; chunk < kModelChunks; ++chunk)
        {
            if (!of_all && !slot_of_index_.contains(chunk / 64))
            {
                continue;
            }
            if (const auto level = level_at(chunk_boxes_[chunk]))
            {
                levels[chunk] = *level;
            }
        }
        return levels;
    }
    [[nodiscard]] std::set<std::uint32_t> met_pages(double wider = 1.0) const
    {
        std::set<std::uint32_t> pages;
        for (std::uint32_t page = 0; page < kModelPages; ++page)
        {
            if (level_at(page_boxes_[page], wider))
            {
                pages.insert(page);
            }
        }
        return pages;
    }

    [[nodiscard]] bool has_index(std::uint32_t page) const { return slot_of_index_.contains(page); }
    [[nodiscard]] bool has_chunk(std::uint32_t chunk) const
    {
        return table_->find({chunk}) != IdTable::kAbsent;
    }
    [[nodiscard]] bool had_chunk(std::uint32_t chunk) const { return before_.contains(chunk); }
    /// True if it was requested, has not arrived and may not have been dropped.
    [[nodiscard]] bool may_be_under_way(ContentKey key) const
    {
        const auto found = asked_.find({key.kind, key.number});
        return found != asked_.end() && (case_.lost_in_100 == 0 || frame - found->second < 100);
    }
    [[nodiscard]] std::uint32_t touched(std::uint32_t chunk) const
    {
        return table_->meta(table_->find({chunk})).touched;
    }
    [[nodiscard]] bool has_credit() const
    {
        return free_chunks_.size() > pool_->chunk_requests.under_way();
    }
    [[nodiscard]] bool has_index_credit() const
    {
        return free_index_.size() > pool_->index_requests.under_way();
    }

    std::optional<ChunkCache> sut;
    std::uint32_t frame{ChunkCache::kFirstFrame};
    WorkCounters work;

private:
    using AskedKey = std::pair<ContentKind, std::uint32_t>;

    /// Boxes of each index page in one part of the model, at random distances.
    void make_boxes()
    {
        for (std::uint32_t page = 0; page < kModelPages; ++page)
        {
            QuantumBox& box = parts_.entries[page].box;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const double low = random_.between(0.0, 0.6 * kModelSide);
                box.low[axis] = static_cast<std::int32_t>(low);
                box.high[axis] = static_cast<std::int32_t>(
                    low + random_.between(0.1 * kModelSide, 0.4 * kModelSide));
            }
            page_boxes_.push_back(in_doubles(box.low, box.high));
            IndexPage& index = index_[page];
            index.chunks = std::min(kModelChunks - 64 * page, 64U);
            Vec3 near{0.5, 0.5, 0.5};
            for (std::uint32_t i = 0; i < index.chunks; ++i)
            {
                near += random_.in_cube(random_.one_in(8) ? 0.5 : 0.1);
                index.set_box(i, random_box(box, near));
                chunk_boxes_.push_back(box_in_quanta(box, index.box(i)));
            }
        }
    }
    /// Box within its page's box, near that place in it.
    InfluenceBox random_box(const QuantumBox& page, Vec3& near)
    {
        InfluenceBox box;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            double& at = near[static_cast<int>(axis)];
            at = std::clamp(at, 0.0, 0.95);
            const double size = random_.between(0.0, random_.one_in(10) ? 0.5 : 0.05);
            const double steps = (page.high[axis] - page.low[axis]) / step_of(page, axis) - 1.0;
            box.low[axis] = static_cast<std::uint16_t>(at * steps);
            box.high[axis] = static_cast<std::uint16_t>(std::min(at + size, 1.0) * steps);
        }
        return box;
    }
    /// Least whole number of quanta of which 65,535 span the page.
    static double step_of(const QuantumBox& page, std::size_t axis)
    {
        return std::floor((page.high[axis] - page.low[axis]) / 65'535.0) + 1.0;
    }
    static std::array<Vec3, 2> in_doubles(const std::array<std::int32_t, 3>& low,
                                          const std::array<std::int32_t, 3>& high)
    {
        return {Vec3(low[0], low[1], low[2]), Vec3(high[0], high[1], high[2])};
    }
    static std::array<Vec3, 2> box_in_quanta(const QuantumBox& page, const InfluenceBox& box)
    {
        std::array<Vec3, 2> quanta;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double step = step_of(page, axis);
            quanta[0][static_cast<int>(axis)] = page.low[axis] + step * box.low[axis];
            quanta[1][static_cast<int>(axis)] = page.low[axis] + step * box.high[axis];
        }
        return quanta;
    }

    void renew(MovingTool& tool)
    {
        tool.center = Vec3(0.5, 0.5, 0.5) * kModelSide + random_.in_cube(0.5 * kModelSide);
        tool.velocity = random_.in_cube(random_.one_in(3) ? 0.0 : 0.01 * kModelSide);
        tool.radius = random_.between(0.001, 0.06) * kModelSide;
        tool.of = static_cast<PriorityClass>(random_.below(3));
        tool.looks_ahead = !random_.one_in(4);
    }
    void move()
    {
        for (MovingTool& tool : tools_)
        {
            tool.center += tool.velocity;
            for (int axis = 0; axis < 3; ++axis)
            {
                const bool is_outside =
                    std::abs(tool.center[axis] - 0.5 * kModelSide) > 0.5 * kModelSide;
                tool.velocity[axis] *= is_outside ? -1.0 : 1.0;
            }
            tool.radius *= random_.one_in(10) ? random_.between(0.9, 1.1) : 1.0;
            if (random_.one_in(10))
            {
                tool.of = static_cast<PriorityClass>(random_.below(3));
            }
            if (random_.one_in(5))
            {
                tool.velocity += random_.in_cube(0.001 * kModelSide);
                tool.velocity *= 0.9;
            }
            if (random_.one_in(40))
            {
                renew(tool);
            }
        }
        if (random_.one_in(40))
        {
            count_ = 1 + random_.below(kMovingTools);
        }
        if (random_.one_in(100))
        {
            model_ = {random_.in_cube(0.2 * kModelSide), random_.in_cube(0.002 * kModelSide),
                      random_.between(0.5, 2.0)};
        }
        model_.at += model_.velocity;
        model_.velocity *= random_.one_in(30) ? 0.0 : 1.0;
    }

    /// Spheres in the order of pairs, at the tools' predicted places.
    [[nodiscard]] RegionRanking spheres()
    {
        RegionRanking ranking;
        spheres_.clear();
        for (std::uint32_t i = 0; i < count_; ++i)
        {
            const MovingTool& tool = tools_[i];
            for (std::uint32_t ahead = 0; ahead < (tool.looks_ahead ? 5U : 1U); ++ahead)
            {
                const Vec3 center =
                    (tool.center + 4.0 * ahead * tool.velocity - model_.at) / model_.scale;
                const double radius = tool.radius * (1.0 + 0.1 * ahead) / model_.scale;
                ranking.push_back({ModelId{0}, center * kModelQuantum, radius * kModelQuantum,
                                   std::int64_t{ahead} * 1'000'000, tool.of});
                spheres_.push_back(
                    {center, radius,
                     2 * static_cast<std::uint32_t>(tool.of) + (ahead == 0 ? 0 : 1)});
            }
        }
        return ranking;
    }
    [[nodiscard]] std::optional<std::uint32_t> level_at(const std::array<Vec3, 2>& box,
                                                        double wider = 1.0) const
    {
        std::optional<std::uint32_t> least;
        for (const auto& [center, radius, level] : spheres_)
        {
            if (distance_to(center, box) <= radius * wider)
            {
                least = std::min(least.value_or(level), level);
            }
        }
        return least;
    }

    void deliver()
    {
        for (std::size_t i = 0; i < coming_.size();)
        {
            if (coming_[i].second > frame || pool_->queues.arrived.size() > 100)
            {
                ++i;
                continue;
            }
            const ContentKey key = coming_[i].first;
            coming_.erase(coming_.begin() + static_cast<std::ptrdiff_t>(i));
            const bool is_chunk = key.kind == ContentKind::chunk;
            auto& free = is_chunk ? free_chunks_ : free_index_;
            ASSERT_FALSE(free.empty()) << "more was asked for than there are slots";
            const std::uint32_t slot = free.front();
            free.pop_front();
            if (!is_chunk)
            {
                slots_.index_pages[slot] = index_[key.number];
                slot_of_index_[key.number] = slot;
            }
            asked_.erase({key.kind, key.number});
            ASSERT_TRUE(pool_->queues.arrived.try_push({key, slot}));
        }
    }
    AskedKeys take_requests()
    {
        AskedKeys keys;
        PieceRequest request;
        while (pool_->queues.wanted.try_pop(request))
        {
            keys.push_back(request.key);
            asked_[{request.key.kind, request.key.number}] = frame;
            if (random_.below(100U) >= case_.lost_in_100)
            {
                coming_.emplace_back(request.key, frame + 1 + random_.below(20U));
            }
        }
        return keys;
    }
    void take_freed()
    {
        FreedSlot freed;
        while (pool_->queues.freed.try_pop(freed))
        {
            (freed.kind == ContentKind::chunk ? free_chunks_ : free_index_).push_back(freed.slot);
            if (freed.kind == ContentKind::index_page)
            {
                std::erase_if(slot_of_index_,
                              [&](const auto& item) { return item.second == freed.slot; });
            }
        }
    }
    [[nodiscard]] std::set<std::uint32_t> resident_chunks() const
    {
        std::set<std::uint32_t> chunks;
        for (std::uint32_t chunk = 0; chunk < kModelChunks; ++chunk)
        {
            if (has_chunk(chunk))
            {
                chunks.insert(chunk);
            }
        }
        return chunks;
    }

    struct OracleSphere
    {
        Vec3 center;
        double radius;
        std::uint32_t level;
    };

    SearchCase case_;
    Random random_;
    HeaderParts parts_;
    std::array<IndexPage, kModelPages> index_;
    std::vector<std::array<Vec3, 2>> page_boxes_;
    std::vector<std::array<Vec3, 2>> chunk_boxes_;
    std::vector<std::byte> bytes_;
    ArenaMemory memory_{1U << 24U};
    Arena arena_{memory_.bytes()};
    PageSlots slots_;
    std::optional<CachePool> pool_;
    std::optional<PageTable> table_;
    std::deque<std::uint32_t> free_chunks_;
    std::deque<std::uint32_t> free_index_;
    std::map<std::uint32_t, std::uint32_t> slot_of_index_;
    std::map<AskedKey, std::uint32_t> asked_; ///< Frame of each request that is still open.
    std::vector<std::pair<ContentKey, std::uint32_t>> coming_;
    std::set<std::uint32_t> before_;
    std::array<MovingTool, kMovingTools> tools_;
    std::uint32_t count_{1};
    MovingModel model_;
    std::vector<OracleSphere> spheres_;
};

Budgets budgets_of(std::uint32_t regions, std::uint32_t requests)
{
    Budgets budgets;
    budgets.regions = regions;
    budgets.requests = requests;
    return budgets;
}

constexpr std::uint32_t kUnlimited = 1'000'000;

class ChunkSearch : public testing::TestWithParam<SearchCase>
{
};

/// Frames from a request to its answer or repetition, and as many for two searches.
constexpr std::uint32_t kSettledFrames = 400;

TEST_P(ChunkSearch, asks_in_each_frame_for_what_a_search_of_all_boxes_asks_for)
{
    const std::uint64_t seed = seed_of(4'305);
    SCOPED_TRACE("TACTUS_SEED=" + std::to_string(seed));
    const SearchCase& test_case = GetParam();
    ChunkSearchRig rig(test_case, seed);
    const bool is_plentiful = test_case.budgets.requests == kUnlimited;
    std::uint64_t asked_of_chunks = 0;
    std::uint64_t rests = 0;
    for (int i = 0; i < 5'000; ++i)
    {
        const AskedKeys keys = rig.step(true);
        SCOPED_TRACE("frame " + std::to_string(i));
        const auto met = rig.met();
        const auto pages = rig.met_pages();
        const auto wide_pages = rig.met_pages(IndexSearch::kWider);
        std::set<std::uint32_t> asked;
        std::uint32_t most_urgent = kWantedLevels;
        for (const ContentKey& key : keys)
        {
            if (key.kind == ContentKind::index_page)
            {
                ASSERT_TRUE(wide_pages.contains(key.number)) << "page " << key.number;
                continue;
            }
            ASSERT_TRUE(met.contains(key.number)) << "chunk " << key.number;
            ASSERT_TRUE(asked.insert(key.number).second) << "twice: chunk " << key.number;
            ASSERT_FALSE(rig.had_chunk(key.number)) << "chunk " << key.number;
            most_urgent = std::min(most_urgent, met.at(key.number));
        }
        asked_of_chunks += asked.size();
        rests += rig.work.skipped.times()[static_cast<std::size_t>(Skip::searches)];
        ASSERT_LE(rig.work.cache_misses, test_case.budgets.requests);
        ASSERT_LE(rig.work.regions_searched, test_case.budgets.regions);
        for (const auto& [chunk, level] : met)
        {
            if (rig.has_chunk(chunk))
            {
                const std::uint32_t age = 64 * level + IndexSearch::kRestFrames + 2;
                ASSERT_TRUE(!is_plentiful || rig.frame - rig.touched(chunk) <= age)
                    << "chunk " << chunk << " of use was not touched";
            }
            else if (is_plentiful && !rig.may_be_under_way({ContentKind::chunk, chunk}))
            {
                ASSERT_FALSE(rig.has_credit()) << "chunk " << chunk << " was not asked for";
            }
        }
        for (const std::uint32_t page : pages)
        {
            ASSERT_TRUE(!is_plentiful || rig.has_index(page) || !rig.has_index_credit() ||
                        rig.may_be_under_way({ContentKind::index_page, page}))
                << "index page " << page << " was not asked for";
        }
    }
    EXPECT_GT(asked_of_chunks, 100U);
    EXPECT_GT(rests, 100U);
}

TEST_P(ChunkSearch, has_all_that_spheres_at_rest_meet_after_a_while)
{
    const std::uint64_t seed = seed_of(4'306);
    SCOPED_TRACE("TACTUS_SEED=" + std::to_string(seed));
    ChunkSearchRig rig(GetParam(), seed);
    for (int round = 0; round < 20; ++round)
    {
        for (int i = 0; i < 50; ++i)
        {
            rig.step(true);
        }
        for (std::uint32_t i = 0; i < kSettledFrames; ++i)
        {
            rig.step(false);
        }
        const auto met = rig.met(true);
        if (met.size() > GetParam().page_slots || rig.met_pages().size() > GetParam().index_slots)
        {
            continue;
        }
        for (const auto& [chunk, level] : met)
        {
            ASSERT_TRUE(rig.has_chunk(chunk)) << "round " << round << " chunk " << chunk;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, ChunkSearch,
    testing::Values(
        SearchCase{"plenty", kModelChunks, kModelPages, 0, budgets_of(kUnlimited, kUnlimited)},
        SearchCase{"few_pages", 60, kModelPages, 0, budgets_of(kUnlimited, kUnlimited)},
        SearchCase{"few_index_pages", kModelChunks, 3, 0, budgets_of(kUnlimited, kUnlimited)},
        SearchCase{"few_of_both_and_some_lost", 80, 4, 10, budgets_of(kUnlimited, kUnlimited)},
        SearchCase{"small_budgets", 200, 6, 3, budgets_of(2, 3)},
        SearchCase{"least_budgets", kModelChunks, kModelPages, 0, budgets_of(1, 1)}),
    [](const testing::TestParamInfo<SearchCase>& named) { return std::string(named.param.name); });

} // namespace

} // namespace tactus::test
