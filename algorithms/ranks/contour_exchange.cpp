// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What ranks tell each other behind the walk of a surface: segments on closed faces, and
// nodes of caps on closed edges, that other ranks may adopt; and in which direction faces are
// divided, so that gaps are found. One exchange.
#include <contours/transition_contours.hpp>

#include <map>

#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

void TransitionContours::note_shared(NodeKey part, std::span<const NodeKey> corners) {
    const auto [at, is_new] = shared_parts_.insert(part, {});
    if (!is_new || !shared_->all_shared(corners)) return;
    at->count = static_cast<std::uint8_t>(corners.size());
    std::copy(corners.begin(), corners.end(), at->key.begin());
}

class TransitionContours::Exchange {
public:
    explicit Exchange(TransitionContours& record)
        : record_{&record}, names_(record.cuts_.size()), box_(record.shared_->ranks().size()) {
        record.vertex_of_.for_each([&](const KeyPair& name, Index v) { names_[v] = name; });
    }

    void run() {
        for (const Segment& segment : record_->segments_) {
            tell(segment.face, [&](Bytes& out, int) { write(out, segment); });
        }
        record_->split_of_.for_each([&](NodeKey face, const Split& split) {
            tell(face, [&](Bytes& out, int) { write(out, face, split); });
        });
        record_->shared_->send(box_, [&](int rank, Reader& in) { read(rank, in); });
        leave_gaps_to_others();
    }

private:
    enum class Kind : std::uint8_t { cut, segment, split };

    /// Calls write(bytes, rank) for the ranks that may have a face or an edge.
    template <class Write>
    void tell(NodeKey part, const Write& write) {
        const Corners* const corners = record_->shared_parts_.find(part);
        if (corners == nullptr || corners->count == 0) return;
        record_->shared_->route(corners->all(), box_, write);
    }

    /// Each message has a cut once, before the first segment that ends there.
    void write_cut(Bytes& out, Index v) {
        if (!written_[&out].insert(v, {}).second) return;
        put(out, Kind::cut);
        put(out, v);
        put(out, names_[v]);
        put(out, record_->cuts_[v]);
        const SurfaceCut cut = record_->cut(v);
        for (const double attribute : cut.attributes) put(out, attribute);
    }
    void write(Bytes& out, const Segment& segment) {
        write_cut(out, segment.from);
        write_cut(out, segment.to);
        put(out, Kind::segment);
        put(out, segment);
    }
    void write(Bytes& out, NodeKey face, const Split& split) const {
        put(out, Kind::split);
        put(out, face);
        put(out, split.by);
        put(out, record_->conflicts_.find(face) != nullptr);
    }

    void read(int rank, Reader& in) {
        KeyTable<Index, Index> own;  // numbers of their vertices here
        while (in.more()) {
            switch (in.get<Kind>()) {
                case Kind::cut:
                    read_cut(in, own);
                    break;
                case Kind::segment: {
                    const auto s = in.get<Segment>();
                    record_->segments_.push_back({s.face, *own.find(s.from), *own.find(s.to)});
                    break;
                }
                case Kind::split:
                    read_split(rank, in);
                    break;
            }
        }
    }
    void read_cut(Reader& in, KeyTable<Index, Index>& own) {
        const auto theirs = in.get<Index>();
        const auto name = in.get<KeyPair>();
        const auto place = in.get<Place>();
        std::vector<double> attributes(record_->attribute_count_);
        for (double& attribute : attributes) attribute = in.get<double>();
        own.insert(theirs, record_->vertex(name, [&] {
            return SurfaceCut{place.x, place.node, place.fraction, attributes};
        }));
    }
    /// Of the ranks that record at a face, the least one fills the gaps there.
    void read_split(int rank, Reader& in) {
        const auto face = in.get<NodeKey>();
        const auto by = in.get<NodeKey>();
        const bool conflicts = in.get<bool>();
        Split* const mine = record_->split_of_.find(face);
        if (mine == nullptr) return;
        if (rank < record_->shared_->ranks().rank()) mine->fills = false;
        if (conflicts || by != mine->by) record_->conflicts_.insert(face, mine->owner);
    }
    void leave_gaps_to_others() {
        KeyTable<NodeKey, Owner> own;
        record_->conflicts_.for_each([&](NodeKey face, const Owner& owner) {
            if (record_->split_of_.find(face)->fills) own.insert(face, owner);
        });
        record_->conflicts_ = std::move(own);
    }

    struct Present {};

    TransitionContours* record_;
    std::vector<KeyPair> names_;  // of the cuts, by number
    Outbox box_;
    std::map<const Bytes*, KeyTable<Index, Present>> written_;
};

void TransitionContours::exchange() { Exchange(*this).run(); }

}  // namespace nestgrid::engine
