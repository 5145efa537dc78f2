// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/validate_cache.hpp"

#include <algorithm>

namespace tactus
{

class CacheValidator
{
public:
    explicit CacheValidator(const ChunkCache& cache) noexcept : cache_(cache) {}

    [[nodiscard]] Flaw find_flaw() noexcept
    {
        check_index();
        const PageTable& pages = *cache_.pages_;
        check_requests(cache_.chunk_requests_, "chunk", pages.used(),
                       [&](std::uint32_t number)
                       { return pages.find(ChunkId{number}) == IdTable::kAbsent; });
        check_requests(cache_.index_requests_, "index page", cache_.index_pages_used_,
                       [&](std::uint32_t number)
                       { return cache_.find_index_page({number}) == IdTable::kAbsent; });
        check_freed();
        const std::uint32_t chunks = cache_.header_.counts().chunks();
        finder_.expect(cache_.fill_cursor_ < chunks || cache_.fill_cursor_ == 0, "chunk",
                       cache_.fill_cursor_, "is next to be loaded and does not exist");
        return finder_.first();
    }

private:
    /// Checks freed slots and base meshes, which are on their way to the transport thread; it may
    /// take them meanwhile.
    void check_freed() noexcept
    {
        const CachePool& pool = *cache_.pool_;
        const auto pages = static_cast<std::size_t>(std::ranges::count_if(
            pool.pages.metas, [](const PageMeta& meta) { return meta.chunk.is_none(); }));
        const auto index_pages = static_cast<std::size_t>(
            std::ranges::count_if(pool.index_metas, [](const CachePool::IndexMeta& meta)
                                  { return meta.page.is_none(); }));
        const std::size_t on_the_way = pool.queues.freed.size();
        finder_.expect(on_the_way <= pages + index_pages + pool.caches_.size(), "cache",
                       static_cast<std::uint32_t>(on_the_way),
                       "slots are on their way back, more than there are free slots");
    }

    void check_index() noexcept
    {
        const ModelCounts counts = cache_.header_.counts();
        std::uint32_t resident = 0;
        for (std::uint32_t slot = 0; slot < cache_.index_meta_.size(); ++slot)
        {
            const IndexPageId page = cache_.index_meta_[slot].page;
            if (page.is_none() || cache_.index_meta_[slot].owner != cache_.pages_->owner())
            {
                continue;
            }
            ++resident;
            if (!finder_.expect(page.value < counts.index_pages(), "index slot", slot,
                                "has a page that the model does not have"))
            {
                continue;
            }
            finder_.expect(cache_.find_index_page(page) == slot, "index page", page.value,
                           "is not found in its slot");
            finder_.expect(cache_.slots_.index_pages[slot].chunks ==
                               chunks_in_index_page(counts, page),
                           "index page", page.value, "has too few or too many chunks");
        }
        finder_.expect(resident == cache_.index_pages_used_, "cache", resident,
                       "index pages are in its slots, but its index differs");
    }

    template <typename IsAway>
    void check_requests(const RequestList& requests, const char* thing, std::uint32_t resident,
                        const IsAway& is_away) noexcept
    {
        finder_.expect(resident == requests.slots_had(), thing, resident,
                       "slots are used, but the pool's count differs");
        std::uint32_t requested = 0;
        const RequestPool& pool = *requests.pool_;
        for (std::uint32_t place = 0; place < pool.requests_.size(); ++place)
        {
            const RequestPool::Request& request = pool.requests_[place];
            if (request.list != &requests)
            {
                continue;
            }
            ++requested;
            const std::uint32_t number = request.key - requests.first_key_;
            finder_.expect(pool.place_of_.find(request.key) == place, thing, number,
                           "is requested twice, or is missing in the list");
            finder_.expect(is_away(number), thing, number, "is requested and resident");
            finder_.expect(request.asked <= cache_.frame_, thing, number,
                           "was requested in a later frame");
        }
        finder_.expect(requested == requests.under_way_, thing, requested,
                       "requests are under way, but the list's count differs");
    }

    const ChunkCache& cache_;
    FlawFinder finder_;
};

Flaw find_flaw(const ChunkCache& cache) noexcept
{
    return CacheValidator(cache).find_flaw();
}

} // namespace tactus
