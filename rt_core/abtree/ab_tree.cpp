// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/abtree/ab_tree.hpp"

#include "rt_core/base/static_vector.hpp"

namespace tactus
{

namespace
{

/// Sibling cells with at most this many faces together become one block again; the gap to the 16
/// at which a block splits keeps a face that comes and goes from splitting it each time.
constexpr std::uint32_t kMergeFaces = 10;

/// The highest octal digit in which two different paths differ, as its shift.
std::uint32_t digit_shift(std::uint64_t a, std::uint64_t b) noexcept
{
    const auto bit = static_cast<std::uint32_t>(63 - std::countl_zero(a ^ b));
    return bit / 3 * 3;
}

} // namespace

AbTree::AbTree(Arena& arena, const Capacities& capacities, float quantum_m) noexcept
    : capacities_(capacities)
    , quantum_m_(quantum_m)
    , blocks_(arena.take<BlockGeometry>(capacities.blocks))
    , sides_(arena.take<BlockSide>(capacities.blocks))
    , nodes_(arena.take<AbNode>(capacities.nodes))
    , prims_(arena.take<Prim>(capacities.prims))
    , free_blocks_(arena.take<std::uint32_t>(capacities.blocks))
    , free_nodes_(arena.take<std::uint32_t>(capacities.nodes))
    , unplaced_(arena.take<PrimId>(capacities.prims))
    , marked_(arena.take<TreeRef>(std::size_t{capacities.blocks} + capacities.nodes))
    , block_marks_(arena.take<std::uint8_t>(capacities.blocks))
    , node_marks_(arena.take<std::uint8_t>(capacities.nodes))
{
    dirty_heads_.fill(kNoNode);
    if (arena.is_measuring())
    {
        return;
    }
    for (auto i = static_cast<std::uint32_t>(free_blocks_.size()); i-- > 0;)
    {
        free_blocks_[free_block_count_++] = i;
    }
    for (auto i = static_cast<std::uint32_t>(free_nodes_.size()); i-- > 0;)
    {
        free_nodes_[free_node_count_++] = i;
    }
}

void AbTree::apply(const ChangedFace& change) noexcept
{
    Prim& prim = prims_[change.prim.value];
    if (prim.leaf == kNoLeaf)
    {
        if (!prim.face.is_none())
        {
            drop_unplaced(change.prim);
        }
    }
    else if (prim.face == change.face)
    {
        update(change);
        return;
    }
    else
    {
        remove(change.prim);
    }
    prim = Prim{change.face, change.bucket, kNoLeaf};
    if (!change.face.is_none())
    {
        insert(change);
    }
}

AbTree::RefitWork AbTree::refit() noexcept
{
    RefitWork work;
    for (const TreeRef ref : marked_.first(marked_count_))
    {
        const std::uint32_t index = ref.index();
        (ref.is_block() ? block_marks_ : node_marks_)[index] = 0;
        if (!ref.is_block())
        {
            if (nodes_[index].in_use != 0)
            {
                enqueue(index);
            }
            continue;
        }
        const BlockSide& side = sides_[index];
        if (side.in_use != 0)
        {
            ++work.blocks;
            pass_up(side.parent, side.child, block_box(blocks_[index], side, quantum_m_),
                    side.coarse != 0);
        }
    }
    marked_count_ = 0;
    for (std::uint32_t level = 0; level < kLevels; ++level)
    {
        // A parent's level is higher than its children's, so it is reached after all of them.
        for (std::uint32_t index = dirty_heads_[level]; index != kNoNode;)
        {
            AbNode& node = nodes_[index];
            Aabb box;
            for (std::uint32_t used = node.mask; used != 0; used &= used - 1)
            {
                box.add(node.box_of(static_cast<std::uint32_t>(std::countr_zero(used))));
            }
            const std::uint32_t next = node.next_dirty;
            node.next_dirty = index; // Out of the list: a node is its own successor.
            pass_up(node.parent, node.child, box, node.coarse != 0);
            ++work.nodes;
            index = next;
        }
        dirty_heads_[level] = kNoNode;
    }
    return work;
}

bool AbTree::has_room_for(std::uint32_t changed_faces) const noexcept
{
    // One changed face splits one block in the ordinary case; the reserve covers the worst one.
    return free_block_count_ >= changed_faces + kReserve &&
           free_node_count_ >= changed_faces + kReserve;
}

NodeStatus AbTree::status(TreeRef ref) const noexcept
{
    const std::uint32_t index = ref.index();
    const bool in_use = ref.is_block() ? sides_[index].in_use != 0 : nodes_[index].in_use != 0;
    if (!in_use)
    {
        return NodeStatus::inactive;
    }
    const bool marked = (ref.is_block() ? block_marks_ : node_marks_)[index] != 0;
    return marked ? NodeStatus::deformed : NodeStatus::active;
}

std::uint64_t AbTree::path_of(FaceId face, std::uint32_t bucket) noexcept
{
    // Multiplying by an odd number is a bijection, so paths of different faces differ; it spreads
    // neighbouring ids over the upper bits, which are looked at first.
    const std::uint32_t mixed = face.value * 0x9E37'79B9U;
    return (std::uint64_t{bucket} << 32U) | mixed;
}

void AbTree::insert(const ChangedFace& face) noexcept
{
    if (free_block_count_ < kReserve || free_node_count_ < kReserve)
    {
        keep_unplaced(face.prim);
        return;
    }
    if (root_.is_none())
    {
        const std::uint32_t block = take_block();
        root_ = TreeRef::to_block(block);
        const bool added = try_add(block, face);
        TACTUS_ASSERT(added);
        return;
    }
    insert_below(root_, face, path_of(face.face, face.bucket));
}

void AbTree::insert_below(TreeRef ref, const ChangedFace& face, std::uint64_t path) noexcept
{
    for (std::uint32_t level = 0; level <= kLevels; ++level)
    {
        if (ref.is_block())
        {
            insert_into_block(ref.index(), face);
            return;
        }
        const AbNode& node = nodes_[ref.index()];
        if (!node.holds(path))
        {
            insert_beside(ref.index(), face, path);
            return;
        }
        const std::uint32_t child = node.child_of(node.digit_of(path));
        if (child == AbNode::kNoChild)
        {
            insert_at_free_digit(ref.index(), face, node.digit_of(path));
            return;
        }
        ref = node.children[child];
    }
    TACTUS_ASSERT(false && "a path has no more digits than levels");
}

/// The path leaves the tree above `node`: a new node takes both.
void AbTree::insert_beside(std::uint32_t node, const ChangedFace& face, std::uint64_t path) noexcept
{
    const std::uint64_t prefix = nodes_[node].prefix;
    const std::uint32_t above = take_node(digit_shift(path, prefix), path);
    const std::uint32_t block = take_block();
    replace(TreeRef::to_node(node), TreeRef::to_node(above));
    attach(above, {nodes_[above].digit_of(prefix), 1}, TreeRef::to_node(node));
    attach(above, {nodes_[above].digit_of(path), 1}, TreeRef::to_block(block));
    const bool added = try_add(block, face);
    TACTUS_ASSERT(added);
}

/// Prefers to widen a block beside the free digit to the binary cell that holds both.
void AbTree::insert_at_free_digit(std::uint32_t node_index, const ChangedFace& face,
                                  std::uint32_t digit) noexcept
{
    AbNode& node = nodes_[node_index];
    for (std::uint32_t width = 2; width <= kNodeChildren; width *= 2)
    {
        const DigitRange cell{digit & ~(width - 1), width};
        const std::uint32_t beside = node.only_child_in(cell);
        if (beside == AbNode::kNoChild)
        {
            continue;
        }
        const bool is_block = beside != AbNode::kSeveral && node.children[beside].is_block();
        if (!is_block || !try_add(node.children[beside].index(), face))
        {
            break;
        }
        node.assign(cell, beside);
        return;
    }
    const std::uint32_t block = take_block();
    attach(node_index, {digit, 1}, TreeRef::to_block(block));
    const bool added = try_add(block, face);
    TACTUS_ASSERT(added);
}

void AbTree::insert_into_block(std::uint32_t block, const ChangedFace& face) noexcept
{
    if (!try_add(block, face))
    {
        split_block(block, face);
    }
}

void AbTree::update(const ChangedFace& face) noexcept
{
    const std::uint32_t leaf = prims_[face.prim.value].leaf;
    const std::uint32_t block = leaf / kBlockFaces;
    remove_from_block(blocks_[block], sides_[block], leaf % kBlockFaces);
    if (try_add(block, face))
    {
        return;
    }
    prims_[face.prim.value].leaf = kNoLeaf;
    mark(TreeRef::to_block(block));
    if (free_block_count_ < kReserve || free_node_count_ < kReserve)
    {
        keep_unplaced(face.prim);
        return;
    }
    split_block(block, face);
}

void AbTree::remove(PrimId prim) noexcept
{
    const std::uint32_t leaf = prims_[prim.value].leaf;
    const std::uint32_t block = leaf / kBlockFaces;
    remove_from_block(blocks_[block], sides_[block], leaf % kBlockFaces);
    prims_[prim.value] = Prim{};
    if (blocks_[block].faces != 0)
    {
        mark(TreeRef::to_block(block));
        merge_upward(block);
        return;
    }
    const std::uint32_t parent = sides_[block].parent;
    const std::uint32_t child = sides_[block].child;
    free_block(block);
    if (parent == kNoNode)
    {
        root_ = TreeRef{};
        return;
    }
    detach(parent, child);
    if (nodes_[parent].child_count() == 1)
    {
        hoist_only_child(parent);
    }
}

bool AbTree::try_add(std::uint32_t block, const ChangedFace& face) noexcept
{
    const std::uint32_t lane = add_to_block(blocks_[block], sides_[block], face);
    if (lane == kBlockFaces)
    {
        return false;
    }
    prims_[face.prim.value].leaf = block * kBlockFaces + lane;
    mark(TreeRef::to_block(block));
    return true;
}

/// The block's faces and one more, which do not fit together, go into smaller binary cells.
void AbTree::split_block(std::uint32_t block, const ChangedFace& face) noexcept
{
    std::array<Keyed, kBlockFaces + 1> faces{};
    std::uint32_t count = 0;
    const auto add_sorted = [&](const ChangedFace& added)
    {
        const std::uint64_t path = path_of(added.face, added.bucket);
        std::uint32_t at = count++;
        for (; at > 0 && faces[at - 1].path > path; --at)
        {
            faces[at] = faces[at - 1];
        }
        faces[at] = {path, added};
    };
    for (std::uint32_t lanes = blocks_[block].faces; lanes != 0; lanes &= lanes - 1)
    {
        add_sorted(face_in(block, static_cast<std::uint32_t>(std::countr_zero(lanes))));
    }
    add_sorted(face);
    const std::uint32_t parent = sides_[block].parent;
    const std::uint32_t child = sides_[block].child;
    free_block(block);
    if (parent == kNoNode)
    {
        root_ = TreeRef{};
    }
    else
    {
        detach(parent, child);
    }
    distribute({faces.data(), count}, {0, count, parent, kNodeChildren});
}

/// Places sorted faces below `cell.parent`, halving by the highest bit in which they differ until
/// each part fits a block. Every halving makes two smaller parts, so at most 16 are on the stack.
void AbTree::distribute(std::span<const Keyed> faces, Cell first) noexcept
{
    StaticVector<Cell, kBlockFaces + 1> stack;
    stack.push_back(first);
    while (!stack.empty())
    {
        Cell cell = stack.pop_back();
        const std::uint32_t count = cell.end - cell.begin;
        if (cell.width < kNodeChildren && try_build_block(faces.subspan(cell.begin, count), cell))
        {
            continue;
        }
        const std::uint64_t low = faces[cell.begin].path;
        const auto bit =
            static_cast<std::uint32_t>(63 - std::countl_zero(low ^ faces[cell.end - 1].path));
        const std::uint32_t shift = bit / 3 * 3;
        if (cell.parent == kNoNode || nodes_[cell.parent].shift != shift)
        {
            const std::uint32_t node = take_node(shift, low);
            if (cell.parent == kNoNode)
            {
                root_ = TreeRef::to_node(node);
            }
            else
            {
                attach(cell.parent, {nodes_[cell.parent].digit_of(low), 1}, TreeRef::to_node(node));
            }
            cell.parent = node;
        }
        std::uint32_t middle = cell.begin;
        while (((faces[middle].path >> bit) & 1U) == 0)
        {
            ++middle;
        }
        const std::uint32_t width = 1U << (bit - shift);
        stack.push_back({middle, cell.end, cell.parent, width});
        stack.push_back({cell.begin, middle, cell.parent, width});
    }
}

bool AbTree::try_build_block(std::span<const Keyed> faces, const Cell& cell) noexcept
{
    if (faces.size() > kBlockFaces)
    {
        return false;
    }
    const std::uint32_t block = take_block();
    for (const Keyed& keyed : faces)
    {
        if (!try_add(block, keyed.face))
        {
            free_block(block);
            return false;
        }
    }
    const std::uint32_t digit = nodes_[cell.parent].digit_of(faces.front().path);
    attach(cell.parent, {digit & ~(cell.width - 1), cell.width}, TreeRef::to_block(block));
    return true;
}

/// A block that lost a face takes in its sibling cell while both fit into kMergeFaces.
void AbTree::merge_upward(std::uint32_t block) noexcept
{
    while (sides_[block].parent != kNoNode && face_count(blocks_[block]) <= kMergeFaces)
    {
        const std::uint32_t parent = sides_[block].parent;
        AbNode& node = nodes_[parent];
        const DigitRange own = node.range_of(sides_[block].child);
        const DigitRange sibling{own.first ^ own.width, own.width};
        const std::uint32_t other = node.only_child_in(sibling);
        if (other == AbNode::kSeveral)
        {
            return;
        }
        if (other != AbNode::kNoChild)
        {
            const TreeRef ref = node.children[other];
            if (!ref.is_block() || !try_absorb(block, ref.index()))
            {
                return;
            }
            detach(parent, other);
        }
        node.assign(sibling, sides_[block].child);
        if (node.child_count() == 1)
        {
            hoist_only_child(parent);
        }
    }
}

/// Moves all faces of `other` into `block` and frees it; nothing changes when they do not fit.
bool AbTree::try_absorb(std::uint32_t block, std::uint32_t other) noexcept
{
    if (face_count(blocks_[block]) + face_count(blocks_[other]) > kMergeFaces)
    {
        return false;
    }
    BlockGeometry geometry = blocks_[block];
    BlockSide side = sides_[block];
    std::array<std::uint32_t, kBlockFaces> lanes{};
    for (std::uint32_t used = blocks_[other].faces; used != 0; used &= used - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(used));
        lanes[lane] = add_to_block(geometry, side, face_in(other, lane));
        if (lanes[lane] == kBlockFaces)
        {
            return false;
        }
    }
    for (std::uint32_t used = blocks_[other].faces; used != 0; used &= used - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(used));
        prims_[sides_[other].prims[lane].value].leaf = block * kBlockFaces + lanes[lane];
    }
    blocks_[block] = geometry;
    sides_[block] = side;
    mark(TreeRef::to_block(block));
    free_block(other);
    return true;
}

void AbTree::hoist_only_child(std::uint32_t node) noexcept
{
    const auto child = static_cast<std::uint32_t>(std::countr_zero(nodes_[node].mask));
    const TreeRef ref = nodes_[node].children[child];
    replace(TreeRef::to_node(node), ref);
    free_node(node);
    mark(ref);
}

void AbTree::attach(std::uint32_t node_index, DigitRange digits, TreeRef ref) noexcept
{
    AbNode& node = nodes_[node_index];
    const auto child = static_cast<std::uint32_t>(std::countr_one(node.mask));
    TACTUS_ASSERT(child < kNodeChildren);
    node.mask = static_cast<std::uint8_t>(node.mask | (1U << child));
    node.children[child] = ref;
    node.set_box(child, Aabb{});
    node.set_coarse(child, false);
    TACTUS_ASSERT(node.only_child_in(digits) == AbNode::kNoChild);
    node.assign(digits, child);
    set_link(ref, node_index, child);
    mark(ref);
    mark(TreeRef::to_node(node_index));
}

void AbTree::detach(std::uint32_t node_index, std::uint32_t child) noexcept
{
    AbNode& node = nodes_[node_index];
    node.mask = static_cast<std::uint8_t>(node.mask & ~(1U << child));
    node.children[child] = TreeRef{};
    node.set_coarse(child, false);
    node.assign(node.range_of(child), AbNode::kNoChild);
    mark(TreeRef::to_node(node_index));
}

/// Puts `new_ref` where `old_ref` hangs: below the same child of the same parent, or at the root.
void AbTree::replace(TreeRef old_ref, TreeRef new_ref) noexcept
{
    const std::uint32_t parent = nodes_[old_ref.index()].parent;
    const std::uint32_t child = nodes_[old_ref.index()].child;
    set_link(new_ref, parent, child);
    if (parent == kNoNode)
    {
        root_ = new_ref;
        return;
    }
    nodes_[parent].children[child] = new_ref;
    mark(TreeRef::to_node(parent));
}

void AbTree::set_link(TreeRef ref, std::uint32_t parent, std::uint32_t child) noexcept
{
    const auto child_byte = static_cast<std::uint8_t>(child);
    if (ref.is_block())
    {
        sides_[ref.index()].parent = parent;
        sides_[ref.index()].child = child_byte;
    }
    else
    {
        nodes_[ref.index()].parent = parent;
        nodes_[ref.index()].child = child_byte;
    }
}

ChangedFace AbTree::face_in(std::uint32_t block, std::uint32_t lane) const noexcept
{
    const PrimId prim = sides_[block].prims[lane];
    const Prim& known = prims_[prim.value];
    return {prim, known.face, known.bucket, sides_[block].errors[lane],
            block_triangle(blocks_[block], lane)};
}

std::uint32_t AbTree::take_block() noexcept
{
    TACTUS_ASSERT(free_block_count_ > 0);
    const std::uint32_t block = free_blocks_[--free_block_count_];
    blocks_[block] = BlockGeometry{};
    sides_[block] = BlockSide{};
    sides_[block].in_use = 1;
    ++blocks_used_;
    blocks_used_max_ = blocks_used_ > blocks_used_max_ ? blocks_used_ : blocks_used_max_;
    return block;
}

std::uint32_t AbTree::take_node(std::uint32_t shift, std::uint64_t prefix) noexcept
{
    TACTUS_ASSERT(free_node_count_ > 0);
    const std::uint32_t index = free_nodes_[--free_node_count_];
    AbNode& node = nodes_[index];
    node = AbNode{};
    node.shift = static_cast<std::uint8_t>(shift);
    node.prefix = prefix;
    node.in_use = 1;
    node.next_dirty = index;
    ++nodes_used_;
    nodes_used_max_ = nodes_used_ > nodes_used_max_ ? nodes_used_ : nodes_used_max_;
    return index;
}

void AbTree::free_block(std::uint32_t block) noexcept
{
    TACTUS_ASSERT(sides_[block].in_use != 0);
    sides_[block].in_use = 0;
    blocks_[block].faces = 0;
    free_blocks_[free_block_count_++] = block;
    --blocks_used_;
}

void AbTree::free_node(std::uint32_t node) noexcept
{
    TACTUS_ASSERT(nodes_[node].in_use != 0);
    nodes_[node].in_use = 0;
    free_nodes_[free_node_count_++] = node;
    --nodes_used_;
}

void AbTree::mark(TreeRef ref) noexcept
{
    std::uint8_t& marked = (ref.is_block() ? block_marks_ : node_marks_)[ref.index()];
    if (marked == 0)
    {
        marked = 1;
        marked_[marked_count_++] = ref;
    }
}

/// Into refit's list of the node's level, unless it is there.
void AbTree::enqueue(std::uint32_t index) noexcept
{
    AbNode& node = nodes_[index];
    if (node.next_dirty == index)
    {
        std::uint32_t& head = dirty_heads_[node.shift / 3];
        node.next_dirty = head;
        head = index;
    }
}

void AbTree::pass_up(std::uint32_t parent, std::uint32_t child, const Aabb& box,
                     bool coarse) noexcept
{
    if (parent == kNoNode)
    {
        return;
    }
    AbNode& node = nodes_[parent];
    const bool was_coarse = ((std::uint32_t{node.coarse} >> child) & 1U) != 0;
    if (node.box_of(child) == box && was_coarse == coarse)
    {
        return;
    }
    node.set_box(child, box);
    node.set_coarse(child, coarse);
    enqueue(parent);
}

void AbTree::keep_unplaced(PrimId prim) noexcept
{
    unplaced_[unplaced_count_++] = prim;
}

void AbTree::drop_unplaced(PrimId prim) noexcept
{
    for (std::uint32_t i = 0; i < unplaced_count_; ++i)
    {
        if (unplaced_[i] == prim)
        {
            unplaced_[i] = unplaced_[--unplaced_count_];
            return;
        }
    }
}

} // namespace tactus
