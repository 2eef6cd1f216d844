// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces of a live grid at the head of a VTK pipeline: each update extracts what has changed.
#pragma once

#include <vtkFieldData.h>

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/outlines.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The isosurface of component 0 of a field of dimension 3, or its isoline in dimension 2. The
/// names of SetGrid() are those of components 1 ...
class IsosurfaceSource : public GridSource {
public:
    using Superclass = GridSource;
    static IsosurfaceSource* New() { VTK_STANDARD_NEW_BODY(IsosurfaceSource); }

    void SetIsovalue(double isovalue) { set(isovalue_, isovalue); }
    double GetIsovalue() const { return isovalue_; }
    /// Isovalues of further surfaces, which one walk draws with the first. Cells tell which one
    /// they belong to ("value").
    void SetMoreIsovalues(const std::vector<double>& isovalues) { set(more_, isovalues); }
    const std::vector<double>& GetMoreIsovalues() const { return more_; }
    /// The edges of the drawn elements on the surface, as lines, in the place of its triangles.
    void SetOutlines(bool on) { set(outlines_, on); }
    bool GetOutlines() const { return outlines_; }
    /// Whether cells tell the number of their element ("element") and its level ("level").
    void SetElements(bool on) { set(options_.elements, on); }
    bool GetElements() const { return options_.elements; }
    /// Whether cells tell where in their element each of their corners lies ("reference").
    void SetReference(bool on) { set(options_.reference, on); }
    bool GetReference() const { return options_.reference; }
    /// Measures at about so many points how far each surface is from the data and from that of all
    /// data, of a grid of dimension 3; 0: not at all. The output tells it as field data: "error",
    /// "distance" and "distance back", for each isovalue the greatest, the mean and the root of the
    /// mean square.
    void SetMeasurePoints(std::size_t points) { set(measure_points_, points); }
    std::size_t GetMeasurePoints() const { return measure_points_; }
    /// What the last update measured, of each isovalue.
    const std::vector<MeasuredError>& GetMeasuredErrors() const { return measured_; }
    /// A distance that the surface and that of all data keep there and back, in units of length.
    void SetDistance(double distance) {
        Projection kept = GetProjection();
        kept.threshold = distance;
        kept.indicator = "slope";
        kept.keeps_distance = true;
        SetProjection(kept);
    }
    void SetNormals(bool on) { set(options_.normals, on); }
    bool GetNormals() const { return options_.normals; }
    /// Closes the surface along the boundary of the domain.
    void SetCap(bool on) { set(options_.cap, on); }
    bool GetCap() const { return options_.cap; }
    /// Vertices lie at nodes in the place of slivers around them.
    void SetAtNodes(bool on) { set(options_.at_nodes, on); }
    bool GetAtNodes() const { return options_.at_nodes; }
    /// Edges are cut where the finest data pass through the isovalue.
    void SetFinestCuts(bool on) { set(options_.cuts, on ? Cuts::finest : Cuts::linear); }
    bool GetFinestCuts() const { return options_.cuts == Cuts::finest; }
    /// How far the surface of the last update may be from the data.
    const ErrorBounds& GetErrorBounds() const { return bounds_; }
    /// The threshold of the last update, which a number of triangles leads to.
    double GetDrawnThreshold() const { return drawn_threshold_; }

protected:
    IsosurfaceSource() = default;
    const char* GetClassNameInternal() const override { return "IsosurfaceSource"; }

    vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) override {
        return prerolls.field().dimension() == 2 ? draw_in<2>(prerolls, work)
                                                 : draw_in<3>(prerolls, work);
    }

private:
    template <int dimension>
    vtkSmartPointer<vtkPolyData> draw_in(Prerolls& prerolls, const Work& work) {
        IsosurfaceOptions options = options_;
        if (outlines_) options.elements = true;
        std::vector<double> isovalues{isovalue_};
        isovalues.insert(isovalues.end(), more_.begin(), more_.end());
        std::vector<Isosurface<dimension>> drawn;
        drawn_threshold_ = projection().least_threshold();
        if (more_.empty()) {
            auto one = isosurface<dimension>(prerolls, isovalue_, projection(), options, work);
            drawn_threshold_ = one.search.threshold;
            drawn.push_back(std::move(one));
        } else {
            drawn = isosurfaces<dimension>(prerolls, isovalues, projection(), options, work);
        }
        bounds_ = {};
        for (const auto& each : drawn) bounds_.add_bounds(each);
        measure(prerolls, drawn, isovalues, work);
        const auto data = poly_data_of(drawn, isovalues);
        if (!measured_.empty()) add_measured(*data);
        return data;
    }

    template <int dimension>
    vtkSmartPointer<vtkPolyData> poly_data_of(std::vector<Isosurface<dimension>>& drawn,
                                              const std::vector<double>& isovalues) {
        if (!outlines_) {
            std::vector<Surface<dimension>> surfaces;
            for (auto& each : drawn) surfaces.push_back(std::move(each.surface));
            return together(surfaces, isovalues);
        }
        if constexpr (dimension == 3) {
            std::vector<Surface<2>> edges;
            for (const auto& each : drawn) edges.push_back(nestgrid::outlines(each.surface));
            return together(edges, isovalues);
        }
        throw InvalidInput("outlines are those of elements on surfaces; the grid has dimension 2");
    }

    template <int dimension>
    void measure(const Prerolls& prerolls, const std::vector<Isosurface<dimension>>& drawn,
                 const std::vector<double>& isovalues, const Work& work) {
        measured_.clear();
        if (measure_points_ == 0) return;
        if constexpr (dimension == 3) {
            for (std::size_t i = 0; i < drawn.size(); ++i) {
                measured_.push_back(
                    measure_error(prerolls, drawn[i].surface, isovalues[i], measure_points_, work));
            }
        } else {
            throw InvalidInput("errors are measured of surfaces; the grid has dimension 2");
        }
    }
    void add_measured(vtkPolyData& data) const {
        const auto add = [&](const char* name, Measured MeasuredError::*number) {
            const vtkNew<vtkDoubleArray> array;
            array->SetName(name);
            array->SetNumberOfComponents(3);
            for (const MeasuredError& each : measured_) {
                const Measured& m = each.*number;
                array->InsertNextTuple3(m.greatest, m.mean, m.rms);
            }
            data.GetFieldData()->AddArray(array);
        };
        add("error", &MeasuredError::value);
        add("distance", &MeasuredError::distance);
        add("distance back", &MeasuredError::back);
    }

    /// All surfaces as one; where there are several, each cell with its isovalue.
    template <int dimension>
    vtkSmartPointer<vtkPolyData> together(const std::vector<Surface<dimension>>& surfaces,
                                          const std::vector<double>& isovalues) {
        if (surfaces.size() == 1) return make_poly_data(surfaces.front(), names());
        Surface<dimension> all;
        const vtkNew<vtkDoubleArray> value;
        value->SetName("value");
        const auto add = [](const auto& part, auto& to) {
            to.insert(to.end(), part.begin(), part.end());
        };
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            const Surface<dimension>& part = surfaces[i];
            const auto vertices = static_cast<std::uint32_t>(all.vertices.size());
            const auto elements = static_cast<std::uint32_t>(all.level_of.size());
            for (auto corners : part.simplices) {
                for (std::uint32_t& v : corners) v += vertices;
                all.simplices.push_back(corners);
                value->InsertNextValue(isovalues[i]);
            }
            for (const std::uint32_t e : part.element_of) all.element_of.push_back(elements + e);
            add(part.level_of, all.level_of);
            add(part.vertices, all.vertices);
            add(part.normals, all.normals);
            add(part.attributes, all.attributes);
            add(part.reference, all.reference);
        }
        const auto data = make_poly_data(all, names());
        data->GetCellData()->AddArray(value);
        return data;
    }

    double isovalue_ = 0;
    std::vector<double> more_;
    bool outlines_ = false;
    IsosurfaceOptions options_;
    std::size_t measure_points_ = 0;
    ErrorBounds bounds_;
    std::vector<MeasuredError> measured_;
    double drawn_threshold_ = 0;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
