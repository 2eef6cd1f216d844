// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frames.hpp"

#include <algorithm>
#include <limits>

#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/error.hpp>

#include "extract.hpp"
#include "frame_files.hpp"
#include "hierarchy.hpp"

using nestgrid::InvalidInput;

std::vector<double> TimeOptions::frame_times() const {
    return times_of_frames(times, more.size() + 1);
}

std::vector<double> TimeOptions::drawn_times() const {
    if (time) return {*time};
    const std::vector<double> all = frame_times();
    std::vector<double> drawn;
    for (int i = 0; i < *frames; ++i) {
        drawn.push_back(all.front() + i * (all.back() - all.front()) / (*frames - 1));
    }
    drawn.back() = all.back();
    return drawn;
}

std::vector<float> TimeOptions::weights(double t) const {
    const std::vector<double> all = frame_times();
    return cubic ? nestgrid::catmull_rom_weights(all, t) : nestgrid::linear_weights(all, t);
}

void add_time_options(CLI::App& command, TimeOptions& options) {
    command.add_option("FRAMES", options.more,
                       "further files of the same layout: later frames of the same field, with "
                       "--time or --frames");
    CLI::Option* time = command.add_option(
        "--time", options.time,
        "a time between the frames, whose times are 0, 1, 2, ... or those of --times");
    command
        .add_option("--frames", options.frames,
                    "so many times from the first frame to the last, as a film: OUTPUT_0000.vtp, "
                    "OUTPUT_0001.vtp, ... and OUTPUT.pvd")
        ->excludes(time);
    command.add_option("--times", options.times, "the times of all frames, ascending")
        ->delimiter(',');
    command.add_flag("--cubic", options.cubic,
                     "interpolate by cubic polynomials (Catmull and Rom) in the place of lines");
}

void check(const TimeOptions& time, const SurfaceOptions& surface) {
    if (!time.in_use()) {
        if (!time.more.empty()) {
            throw InvalidInput("several inputs need a --time between them, or --frames for a film");
        }
        if (!time.times.empty() || time.cubic) {
            throw InvalidInput("--times and --cubic need --time or --frames");
        }
        return;
    }
    if (time.more.empty()) throw InvalidInput("--time and --frames need several inputs");
    time.frame_times();  // throws where there is not one for each input
    if (!surface.budgets.empty()) throw InvalidInput("--max-triangles is for one input");
    if (time.frames) {
        if (*time.frames < 2) throw InvalidInput("--frames is below 2");
        if (surface.output.extension() != ".vtp") {
            throw InvalidInput("a film needs an --output with the name of a .vtp file");
        }
        if (!surface.image.empty()) throw InvalidInput("--image draws no films");
        if (surface.thresholds.size() > 1) throw InvalidInput("a film has one --threshold");
    }
    for (const double t : time.drawn_times()) time.weights(t);
}

namespace {

template <class Grid, class Field>
class FramesOf final : public Frames {
public:
    FramesOf(const Grid& grid, const std::vector<Field>& fields, const std::string& field,
             int threads)
        : grid_{grid}, fields_{fields} {
        const double start = now();
        const nestgrid::TbbExecutor executor(threads);
        for (const Field& f : fields) indicators_.emplace_back(grid, f, executor);
        name = field;
        dimension = Grid::dimension;
        least = std::numeric_limits<double>::infinity();
        greatest = -least;
        for (const auto& frame : indicators_) {
            least = std::min(least, frame.least());
            greatest = std::max(greatest, frame.greatest());
            preroll_bytes += frame.memory_bytes();
        }
        preroll_seconds = now() - start;
    }

    nestgrid::Region region(const Inside& inside) const override { return {grid_, inside}; }

private:
    void at_weights(std::span<const float> weights, const Take<float>& as_float,
                    const Take<double>& as_double) const override {
        std::vector<const Field*> fields;
        std::vector<const nestgrid::HierarchicalIndicator*> indicators;
        for (const Field& field : fields_) fields.push_back(&field);
        for (const auto& indicator : indicators_) indicators.push_back(&indicator);
        const nestgrid::KeyFrames key_frames(indicators, weights);
        const nestgrid::Between<Field> between(fields, weights);
        const auto hierarchy = nestgrid::erase(grid_, between);
        if constexpr (std::is_same_v<typename Field::value_type, float>) {
            as_float(hierarchy, key_frames);
        } else {
            as_double(hierarchy, key_frames);
        }
    }

    const Grid& grid_;
    const std::vector<Field>& fields_;
    std::vector<nestgrid::HierarchicalIndicator> indicators_;
};

using Function = std::function<void(const Frames&)>;

void with_volumes(Input& input, const Paths& paths, int threads, const Function& function) {
    using Grid = nestgrid::LatticeBisection<3>;
    std::vector<Volume> volumes;
    for (const auto& path : paths) {
        input.path = path;
        volumes.push_back(read_volume(input));
    }
    require_one_layout(volumes, paths);
    const Grid grid(volumes.front().geometry);
    with_samples(volumes.front(), [&]<class Sample>(std::span<const Sample> samples) {
        std::vector<nestgrid::LatticeField<Grid, Sample>> fields;
        for (const Volume& volume : volumes) {
            const auto* data = static_cast<const Sample*>(volume.image->GetScalarPointer());
            fields.emplace_back(grid, std::span(data, samples.size()));
        }
        FramesOf frames(grid, fields, input.array.empty() ? std::string("value") : input.array,
                        threads);
        frames.nodes = grid.sample_count();
        frames.leaf_elements = leaf_count(grid);
        function(frames);
    });
}

void with_hierarchies(const Paths& paths, const std::string& array, int threads,
                      const Function& function) {
    with_hierarchy(paths.front(), [&]<class Family>(nestgrid::StoredHierarchy<Family>& first) {
        using Grid = nestgrid::StoredGrid<Family>;
        const nestgrid::NamedField& named = field_named(first.fields, array);
        const std::vector<std::vector<double>> values = frame_values(first, paths, array);
        std::vector<nestgrid::NodeField<Grid, double>> fields;
        for (const auto& v : values) fields.emplace_back(first.grid, v);
        FramesOf frames(first.grid, fields, named.name, threads);
        frames.nodes = first.grid.used_node_count();
        frames.leaf_elements = first.grid.leaf_count();
        function(frames);
    });
}

}  // namespace

void with_frames(Input& input, const TimeOptions& time, int threads, const Function& function) {
    Paths paths{input.path};
    paths.insert(paths.end(), time.more.begin(), time.more.end());
    if (is_hierarchy(input.path)) {
        with_hierarchies(paths, input.array, threads, function);
    } else {
        with_volumes(input, paths, threads, function);
    }
}
