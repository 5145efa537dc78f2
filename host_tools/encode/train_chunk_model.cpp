// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Prints rt_core/spm/chunk_model.inc: the initial probabilities of a chunk, trained on the given
/// models. Other values require another coder version.

#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/chunk_grammar.hpp"
#include "transport/store/model_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

namespace tactus
{

namespace
{

struct BitCount
{
    double zeros{0.0};
    double ones{0.0};
};
using Counts = std::vector<BitCount>;

/// Coder that only counts the zeros and ones that a grammar writes, for each probability.
class CountingCoder
{
public:
    explicit CountingCoder(Counts& counts) : counts_(counts) {}

    void count_for(const ChunkModel& model)
    {
        first_ = reinterpret_cast<const Probability*>(&model);
    }
    std::uint32_t code_bit(Probability& zero, std::uint32_t bit)
    {
        BitCount& count = counts_[static_cast<std::size_t>(&zero - first_)];
        (bit != 0 ? count.ones : count.zeros) += 1.0;
        return bit;
    }
    static std::uint32_t code_raw(std::uint32_t /*bits*/, std::uint32_t value) { return value; }

private:
    Counts& counts_;
    const Probability* first_{nullptr};
};

bool count_model(const char* path, Counts& counts)
{
    const auto store = ModelStore::open(path);
    if (!store)
    {
        fmt::print(stderr, "train_chunk_model: {}\n", store.error().text);
        return false;
    }
    const ModelHeader& header = store.value().header();
    const auto page = std::make_unique<Page>();
    std::vector<std::byte> coded;
    // Every model has the same weight, regardless of its size.
    Counts own(counts.size());
    for (std::uint32_t chunk = 0; chunk < header.counts().chunks(); ++chunk)
    {
        if (!store.value().read({ContentKind::chunk, chunk}, coded) ||
            !parse_chunk(coded, header, {chunk}, *page))
        {
            fmt::print(stderr, "train_chunk_model: {}: chunk {} is damaged\n", path, chunk);
            return false;
        }
        CountingCoder coder(own);
        ChunkGrammar grammar(coder, header.counts(), {chunk});
        coder.count_for(grammar.model());
        for (std::uint32_t place = 0; place < records_in_chunk(header.counts(), {chunk}); ++place)
        {
            CodedRecord record = coded_form(page->records[place]);
            grammar.code({(chunk << kRecordsPerChunkLog2) + place}, record);
        }
    }
    for (std::size_t i = 0; i < counts.size(); ++i)
    {
        counts[i].zeros += own[i].zeros / header.counts().records;
        counts[i].ones += own[i].ones / header.counts().records;
    }
    return true;
}

void print_model(const Counts& counts)
{
    constexpr std::size_t kPerLine = 14;
    constexpr double kUnsure = 1e-5; // Prior occurrences of each bit in a record.
    for (std::size_t i = 0; i < counts.size(); ++i)
    {
        const double zeros = counts[i].zeros + kUnsure;
        const double share = zeros / (zeros + counts[i].ones + kUnsure);
        const auto probability = static_cast<int>(std::clamp(share * 4096.0, 48.0, 4048.0));
        const char* end = i + 1 == counts.size()         ? "\n"
                          : i % kPerLine == kPerLine - 1 ? ",\n"
                                                         : ", ";
        fmt::print("{}{}", probability, end);
    }
}

} // namespace

} // namespace tactus

int main(int argc, char** argv)
{
    tactus::Counts counts(tactus::kChunkProbabilities);
    if (argc < 2)
    {
        fmt::print(stderr, "usage: train_chunk_model MODEL.spm ...\n");
        return 3;
    }
    for (int i = 1; i < argc; ++i)
    {
        if (!tactus::count_model(argv[i], counts))
        {
            return 2;
        }
    }
    tactus::print_model(counts);
    return 0;
}
