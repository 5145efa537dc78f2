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
        check_wishes(cache_.chunk_wishes_, "chunk", pages.used(),
                     [&](std::uint32_t number)
                     { return pages.find(ChunkId{number}) == IdTable::kAbsent; });
        check_wishes(cache_.index_wishes_, "index page", cache_.index_pages_used_,
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
        const std::size_t on_the_way = pool.door.freed.size();
        finder_.expect(on_the_way <= pages + index_pages + pool.caches_.size(), "cache",
                       static_cast<std::uint32_t>(on_the_way),
                       "slots are on their way back, more than are not its own");
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
                           "is found elsewhere or nowhere");
            finder_.expect(cache_.slots_.index_pages[slot].chunks ==
                               chunks_in_index_page(counts, page),
                           "index page", page.value, "has too few or too many chunks");
        }
        finder_.expect(resident == cache_.index_pages_used_, "cache", resident,
                       "index pages are in its slots, and its index has others");
    }

    template <typename IsAway>
    void check_wishes(const WishList& wishes, const char* thing, std::uint32_t resident,
                      const IsAway& is_away) noexcept
    {
        finder_.expect(resident == wishes.slots_had(), thing, resident,
                       "slots are used here, and its pool counts others");
        std::uint32_t wished = 0;
        const WishPool& pool = *wishes.pool_;
        for (std::uint32_t place = 0; place < pool.wishes_.size(); ++place)
        {
            const WishPool::Wish& wish = pool.wishes_[place];
            if (wish.list != &wishes)
            {
                continue;
            }
            ++wished;
            const std::uint32_t number = wish.key - wishes.first_key_;
            finder_.expect(pool.place_of_.find(wish.key) == place, thing, number,
                           "is wished for twice, or is not known to be");
            finder_.expect(is_away(number), thing, number, "is wished for and here");
            finder_.expect(wish.asked <= cache_.frame_, thing, number,
                           "was wished for in a later frame");
        }
        finder_.expect(wished == wishes.under_way_, thing, wished,
                       "wishes are under way, and the list counts others");
    }

    const ChunkCache& cache_;
    FlawFinder finder_;
};

Flaw find_flaw(const ChunkCache& cache) noexcept
{
    return CacheValidator(cache).find_flaw();
}

} // namespace tactus
