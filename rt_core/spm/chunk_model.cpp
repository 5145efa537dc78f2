// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/chunk_grammar.hpp"

#include <bit>

namespace tactus
{

namespace
{

/// Part of coder version 3: learnt once from a few models (train_chunk_model) and fixed since.
constexpr std::array<Probability, kChunkProbabilities> kLearnt{
#include "rt_core/spm/chunk_model.inc"
};

constexpr ChunkModel kInitial = std::bit_cast<ChunkModel>(kLearnt);

} // namespace

const ChunkModel& initial_chunk_model() noexcept
{
    return kInitial;
}

} // namespace tactus
