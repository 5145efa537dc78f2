// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/validate_cache.hpp"

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
        check_wishes(cache_.index_wishes_, "index page", cache_.index_slot_of_.size(),
                     [&](std::uint32_t number)
                     { return cache_.index_slot_of_.find(number) == IdTable::kAbsent; });
        // Freed slots are on their way to the transport thread, which may take them meanwhile.
        const std::size_t on_the_way = cache_.inbox_->freed.size();
        const std::size_t at_transport = std::size_t{cache_.chunk_wishes_.slots_at_transport_} +
                                         cache_.index_wishes_.slots_at_transport_;
        finder_.expect(on_the_way <= at_transport, "cache", static_cast<std::uint32_t>(on_the_way),
                       "slots are on their way back, more than are not its own");
        const std::uint32_t chunks = cache_.header_.counts().chunks();
        finder_.expect(cache_.fill_cursor_ < chunks || cache_.fill_cursor_ == 0, "chunk",
                       cache_.fill_cursor_, "is next to be loaded and does not exist");
        return finder_.first();
    }

private:
    void check_index() noexcept
    {
        const ModelCounts counts = cache_.header_.counts();
        std::uint32_t resident = 0;
        for (std::uint32_t slot = 0; slot < cache_.index_meta_.size(); ++slot)
        {
            const IndexPageId page = cache_.index_meta_[slot].page;
            if (page.is_none())
            {
                continue;
            }
            ++resident;
            if (!finder_.expect(page.value < counts.index_pages(), "index slot", slot,
                                "has a page that the model does not have"))
            {
                continue;
            }
            finder_.expect(cache_.index_slot_of_.find(page.value) == slot, "index page", page.value,
                           "is found elsewhere or nowhere");
            finder_.expect(cache_.slots_.index_pages[slot].chunks ==
                               chunks_in_index_page(counts, page),
                           "index page", page.value, "has too few or too many chunks");
        }
        finder_.expect(resident == cache_.index_slot_of_.size(), "cache", resident,
                       "index pages are in its slots, and its index has others");
    }

    template <typename IsAway>
    void check_wishes(const WishList& wishes, const char* thing, std::uint32_t resident,
                      const IsAway& is_away) noexcept
    {
        finder_.expect(resident + wishes.slots_at_transport_ == wishes.numbers_.size(), thing,
                       resident,
                       "slots are used here, and the others are not all at the transport");
        std::uint32_t wished = 0;
        for (std::uint32_t place = 0; place < wishes.numbers_.size(); ++place)
        {
            const std::uint32_t number = wishes.numbers_[place];
            if (number == IdTable::kAbsent)
            {
                continue;
            }
            ++wished;
            finder_.expect(wishes.under_way_.find(number) == place, thing, number,
                           "is wished for twice, or is not known to be");
            finder_.expect(is_away(number), thing, number, "is wished for and here");
            finder_.expect(wishes.asked_[place] <= cache_.frame_, thing, number,
                           "was wished for in a later frame");
        }
        finder_.expect(wished == wishes.under_way_.size(), thing, wished,
                       "wishes are under way, and the list's index has others");
    }

    const ChunkCache& cache_;
    FlawFinder finder_;
};

Flaw find_flaw(const ChunkCache& cache) noexcept
{
    return CacheValidator(cache).find_flaw();
}

} // namespace tactus
