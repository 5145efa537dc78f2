// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/validate_pages.hpp"

#include "rt_core/spm/chunk_coding.hpp"

namespace tactus
{

Flaw find_flaw(const PageTable& pages, const ModelCounts& counts) noexcept
{
    FlawFinder finder;
    std::uint32_t resident = 0;
    for (std::uint32_t slot = 0; slot < pages.capacity(); ++slot)
    {
        const PageTable::Meta& meta = pages.meta(slot);
        if (meta.chunk.is_none())
        {
            finder.expect((meta.linked | meta.refined | meta.held) == 0, "slot", slot,
                          "has records and no page");
            continue;
        }
        if (!pages.is_own(slot))
        {
            continue;
        }
        ++resident;
        if (!finder.expect(meta.chunk.value < counts.chunks(), "slot", slot,
                           "has a chunk that the model does not have"))
        {
            continue;
        }
        const std::uint64_t all =
            ~std::uint64_t{0} >> (kRecordsPerChunk - records_in_chunk(counts, meta.chunk));
        finder.expect(pages.find(meta.chunk) == slot, "slot", slot,
                      "has a page that is not found in this slot");
        finder.expect((meta.linked & ~all) == 0, "slot", slot, "links records beyond the last");
        finder.expect((meta.refined & ~meta.linked) == 0, "slot", slot,
                      "has a refined record that is not linked");
        finder.expect((meta.held & ~meta.refined) == 0, "slot", slot,
                      "holds a record that is not refined");
    }
    // Every page is found in its own slot, so equal counts leave none in the index alone.
    finder.expect(resident == pages.used(), "table", resident,
                  "pages are in its slots, but its index differs");
    return finder.first();
}

} // namespace tactus
