! SPDX-FileCopyrightText: the nestgrid authors
! SPDX-License-Identifier: BSD-3-Clause
!
! The tables and functions of nestgrid.h, options.h, ranks.h, isosurface.h, slice.h,
! discontinuous.h, isolines.h, probe.h and surface_measures.h for Fortran codes, with the same names
! and members. Those headers say what each means; what Fortran adds:
!   - functions go into tables by c_funloc(f), where f has bind(c) and the arguments that the header
!     names; a member that is not set is NULL, or 0, its default;
!   - `size` is set to c_sizeof(table) before a table, options or a result are handed over;
!   - what a result points to becomes an array by c_f_pointer(lines%vertices, x, [3_c_size_t,
!     lines%vertex_count]);
!   - indices count from 0, as in C;
!   - a message is a character(len=n) with its length n, and ends at c_null_char.
module nestgrid
    use, intrinsic :: iso_c_binding
    implicit none

    integer(c_int), parameter :: NESTGRID_SEGMENT = 1
    integer(c_int), parameter :: NESTGRID_TRIANGLE = 2
    integer(c_int), parameter :: NESTGRID_QUADRILATERAL = 3
    integer(c_int), parameter :: NESTGRID_TETRAHEDRON = 4
    integer(c_int), parameter :: NESTGRID_PYRAMID = 5
    integer(c_int), parameter :: NESTGRID_PRISM = 6
    integer(c_int), parameter :: NESTGRID_HEXAHEDRON = 7

    integer(c_int), parameter :: NESTGRID_FLOAT = 0
    integer(c_int), parameter :: NESTGRID_DOUBLE = 1

    integer(c_int64_t), parameter :: NESTGRID_NO_NODE = -1_c_int64_t

    integer(c_int), parameter :: NESTGRID_MAX = 0
    integer(c_int), parameter :: NESTGRID_MIN = 1
    integer(c_int), parameter :: NESTGRID_SUM = 2

    integer(c_int), parameter :: NESTGRID_OFFSET = 0
    integer(c_int), parameter :: NESTGRID_DEVIATION = 1
    integer(c_int), parameter :: NESTGRID_NUMERICAL = 2
    integer(c_int), parameter :: NESTGRID_WAVELET = 3
    integer(c_int), parameter :: NESTGRID_VISUAL = 4
    integer(c_int), parameter :: NESTGRID_GEOMETRY = 5
    integer(c_int), parameter :: NESTGRID_CUT = 6
    integer(c_int), parameter :: NESTGRID_SLOPE = 7
    integer(c_int), parameter :: NESTGRID_NORM = 8

    integer(c_int), parameter :: NESTGRID_ALL_THREADS = -1
    integer(c_int32_t), parameter :: NESTGRID_NO_ELEMENT = -1_c_int32_t

    type, bind(c) :: nestgrid_element
        integer(c_int64_t) :: word(6) = 0_c_int64_t
    end type nestgrid_element

    type, bind(c) :: nestgrid_coarse
        type(nestgrid_element) :: element
        integer(c_int) :: shape = 0_c_int
        real(c_double) :: corners(3, 8) = 0.0_c_double
        integer(c_int64_t) :: ids(8) = 0_c_int64_t
        integer(c_int) :: orientation = 0_c_int
    end type nestgrid_coarse

    type, bind(c) :: nestgrid_stencil
        integer(c_int) :: count = 0_c_int
        integer(c_int) :: parent(8) = 0_c_int
        real(c_double) :: weight(8) = 0.0_c_double
        integer(c_int) :: number = 0_c_int
    end type nestgrid_stencil

    type, bind(c) :: nestgrid_child
        integer(c_int) :: shape = 0_c_int
        integer(c_int) :: corner(8) = 0_c_int
        integer(c_int) :: orientation = 0_c_int
    end type nestgrid_child

    type, bind(c) :: nestgrid_rule
        type(c_ptr) :: name = c_null_ptr
        integer(c_int) :: shape = 0_c_int
        integer(c_int) :: new_node_count = 0_c_int
        type(c_ptr) :: new_nodes = c_null_ptr
        integer(c_int) :: child_count = 0_c_int
        type(c_ptr) :: children = c_null_ptr
    end type nestgrid_rule

    type, bind(c) :: nestgrid_grid
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: self = c_null_ptr
        integer(c_int) :: dimension = 0_c_int
        integer(c_int) :: rule_count = 0_c_int
        type(c_ptr) :: rules = c_null_ptr
        type(c_funptr) :: coarse_count = c_null_funptr
        type(c_funptr) :: coarse = c_null_funptr
        type(c_funptr) :: split = c_null_funptr
        type(c_funptr) :: children = c_null_funptr
        type(c_funptr) :: corner_keys = c_null_funptr
        type(c_funptr) :: new_keys = c_null_funptr
        integer(c_size_t) :: node_count = 0_c_size_t
        type(c_funptr) :: corner_positions = c_null_funptr
        type(c_funptr) :: new_positions = c_null_funptr
        type(c_funptr) :: constrained = c_null_funptr
        integer(c_int) :: conforming = 0_c_int
        type(c_funptr) :: masked = c_null_funptr
        type(c_funptr) :: hidden = c_null_funptr
        type(c_funptr) :: outside = c_null_funptr
        type(c_funptr) :: boundary_faces = c_null_funptr
        type(c_funptr) :: epoch = c_null_funptr
        type(c_funptr) :: make_context = c_null_funptr
        type(c_funptr) :: free_context = c_null_funptr
        type(c_funptr) :: middles = c_null_funptr
        type(c_funptr) :: node_keys = c_null_funptr
        type(c_funptr) :: node_positions = c_null_funptr
        type(c_funptr) :: last_error = c_null_funptr
        type(c_funptr) :: hanging_parents = c_null_funptr
        type(c_funptr) :: presence = c_null_funptr
        type(c_funptr) :: geometry_degree = c_null_funptr
        type(c_funptr) :: map = c_null_funptr
    end type nestgrid_grid

    type, bind(c) :: nestgrid_field
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: self = c_null_ptr
        integer(c_int) :: value_type = 0_c_int
        integer(c_int) :: components = 0_c_int
        type(c_funptr) :: coarse_values = c_null_funptr
        type(c_funptr) :: new_values = c_null_funptr
        type(c_funptr) :: corner_gradients = c_null_funptr
        type(c_funptr) :: node_values = c_null_funptr
        type(c_funptr) :: last_error = c_null_funptr
        type(c_funptr) :: node_gradients = c_null_funptr
        type(c_funptr) :: degree = c_null_funptr
        type(c_funptr) :: evaluate = c_null_funptr
    end type nestgrid_field

    type, bind(c) :: nestgrid_lens
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: self = c_null_ptr
        type(c_funptr) :: distance = c_null_funptr
        real(c_double) :: finest = 0.0_c_double
        real(c_double) :: coarsest = 0.0_c_double
        real(c_double) :: slope = 0.0_c_double
    end type nestgrid_lens

    type, bind(c) :: nestgrid_region
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: self = c_null_ptr
        type(c_funptr) :: distance = c_null_funptr
        real(c_double) :: threshold = 0.0_c_double
    end type nestgrid_region

    type, bind(c) :: nestgrid_message
        integer(c_int) :: rank = 0_c_int
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: bytes = c_null_ptr
    end type nestgrid_message

    type, bind(c) :: nestgrid_ranks
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: self = c_null_ptr
        integer(c_int) :: rank = 0_c_int
        integer(c_int) :: count = 0_c_int
        type(c_funptr) :: exchange = c_null_funptr
        type(c_funptr) :: gather = c_null_funptr
        type(c_funptr) :: reduce = c_null_funptr
        type(c_funptr) :: last_error = c_null_funptr
    end type nestgrid_ranks

    type, bind(c) :: nestgrid_options
        integer(c_size_t) :: size = 0_c_size_t
        real(c_double) :: threshold = 0.0_c_double
        real(c_double) :: error = 0.0_c_double
        integer(c_int64_t) :: max_triangles = 0_c_int64_t
        integer(c_int) :: indicator = 0_c_int
        integer(c_int) :: threads = 0_c_int
        integer(c_int) :: normals = 0_c_int
        integer(c_int) :: cap = 0_c_int
        integer(c_int) :: at_nodes = 0_c_int
        integer(c_int) :: finest_cuts = 0_c_int
        integer(c_int) :: elements = 0_c_int
        integer(c_int) :: reference = 0_c_int
        type(c_ptr) :: attributes = c_null_ptr
        integer(c_size_t) :: attribute_count = 0_c_size_t
        type(c_funptr) :: progress = c_null_funptr
        type(c_ptr) :: progress_data = c_null_ptr
        type(c_ptr) :: prerolls = c_null_ptr
        integer(c_int) :: collapse = 0_c_int
        integer(c_int) :: keep_distance = 0_c_int
        real(c_double) :: blend = 0.0_c_double
        type(c_ptr) :: lens = c_null_ptr
        real(c_double) :: slice_distance = 0.0_c_double
        type(c_ptr) :: region = c_null_ptr
        real(c_double) :: colour_tolerance = 0.0_c_double
        type(c_ptr) :: ranks = c_null_ptr
        real(c_double) :: position_error = 0.0_c_double
    end type nestgrid_options

    type, bind(c) :: nestgrid_surface
        integer(c_size_t) :: vertex_count = 0_c_size_t
        type(c_ptr) :: vertices = c_null_ptr
        integer(c_size_t) :: simplex_count = 0_c_size_t
        type(c_ptr) :: simplices = c_null_ptr
        integer(c_int) :: dimension = 0_c_int
        real(c_double) :: error_bound = 0.0_c_double
        integer(c_int64_t) :: visited = 0_c_int64_t
        integer(c_int64_t) :: extracted = 0_c_int64_t
        real(c_double) :: range_bound = 0.0_c_double
        integer(c_int) :: bound_says_nothing = 0_c_int
        type(c_ptr) :: owner = c_null_ptr
    end type nestgrid_surface

    type, bind(c) :: nestgrid_measure_of
        real(c_double) :: greatest = 0.0_c_double
        real(c_double) :: mean = 0.0_c_double
        real(c_double) :: rms = 0.0_c_double
    end type nestgrid_measure_of

    type, bind(c) :: nestgrid_measured
        integer(c_size_t) :: size = 0_c_size_t
        type(nestgrid_measure_of) :: value
        type(nestgrid_measure_of) :: distance
        type(nestgrid_measure_of) :: back
        real(c_double) :: reach = 0.0_c_double
        integer(c_int64_t) :: points = 0_c_int64_t
    end type nestgrid_measured

    type, bind(c) :: nestgrid_surface_details
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: normals = c_null_ptr
        integer(c_size_t) :: attribute_count = 0_c_size_t
        type(c_ptr) :: attributes = c_null_ptr
        integer(c_size_t) :: element_count = 0_c_size_t
        type(c_ptr) :: elements = c_null_ptr
        type(c_ptr) :: shapes = c_null_ptr
        type(c_ptr) :: levels = c_null_ptr
        type(c_ptr) :: element_of = c_null_ptr
        type(c_ptr) :: reference = c_null_ptr
        integer(c_size_t) :: boundary_count = 0_c_size_t
        type(c_ptr) :: boundary = c_null_ptr
        real(c_double) :: threshold = 0.0_c_double
        real(c_double) :: surface_error = 0.0_c_double
        integer(c_int) :: cancelled = 0_c_int
        type(c_ptr) :: budget_text = c_null_ptr
        real(c_double) :: position_bound = 0.0_c_double
    end type nestgrid_surface_details

    type, bind(c) :: nestgrid_joined
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: owner = c_null_ptr
        type(c_ptr) :: numbers = c_null_ptr
        type(c_ptr) :: owners = c_null_ptr
        integer(c_int64_t) :: vertices = 0_c_int64_t
        integer(c_int64_t) :: simplices = 0_c_int64_t
        integer(c_int64_t) :: components = 0_c_int64_t
        integer(c_int64_t) :: open = 0_c_int64_t
    end type nestgrid_joined

    type, bind(c) :: nestgrid_measures
        integer(c_int64_t) :: triangles = 0_c_int64_t
        real(c_double) :: area = 0.0_c_double
        real(c_double) :: area_vector(3) = 0.0_c_double
        real(c_double) :: volume = 0.0_c_double
        real(c_double) :: flux = 0.0_c_double
        type(c_ptr) :: integrals = c_null_ptr
        integer(c_int) :: closed = 0_c_int
    end type nestgrid_measures

    type, bind(c) :: nestgrid_surface_measures
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: owner = c_null_ptr
        type(nestgrid_measures) :: whole
        integer(c_size_t) :: component_count = 0_c_size_t
        type(c_ptr) :: components = c_null_ptr
        type(c_ptr) :: component_of = c_null_ptr
    end type nestgrid_surface_measures

    type, bind(c) :: nestgrid_level_function
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: self = c_null_ptr
        type(c_funptr) :: value = c_null_funptr
        type(c_funptr) :: variation = c_null_funptr
        integer(c_int) :: affine = 0_c_int
    end type nestgrid_level_function

    type, bind(c) :: nestgrid_leaf_data
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: self = c_null_ptr
        integer(c_int) :: components = 0_c_int
        type(c_funptr) :: leaf_values = c_null_funptr
    end type nestgrid_leaf_data

    type, bind(c) :: nestgrid_lines
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: owner = c_null_ptr
        integer(c_size_t) :: vertex_count = 0_c_size_t
        type(c_ptr) :: vertices = c_null_ptr
        integer(c_size_t) :: attribute_count = 0_c_size_t
        type(c_ptr) :: attributes = c_null_ptr
        integer(c_size_t) :: line_count = 0_c_size_t
        type(c_ptr) :: first = c_null_ptr
        type(c_ptr) :: points = c_null_ptr
        type(c_ptr) :: values = c_null_ptr
        real(c_double) :: error_bound = 0.0_c_double
        real(c_double) :: range_bound = 0.0_c_double
        integer(c_int64_t) :: visited = 0_c_int64_t
        integer(c_int64_t) :: extracted = 0_c_int64_t
        integer(c_int) :: cancelled = 0_c_int
        real(c_double) :: position_bound = 0.0_c_double
    end type nestgrid_lines

    type, bind(c) :: nestgrid_probed
        integer(c_size_t) :: size = 0_c_size_t
        type(c_ptr) :: owner = c_null_ptr
        integer(c_size_t) :: point_count = 0_c_size_t
        integer(c_size_t) :: found = 0_c_size_t
        integer(c_size_t) :: component_count = 0_c_size_t
        type(c_ptr) :: values = c_null_ptr
        type(c_ptr) :: levels = c_null_ptr
        type(c_ptr) :: element_of = c_null_ptr
        type(c_ptr) :: reference = c_null_ptr
        integer(c_size_t) :: element_count = 0_c_size_t
        type(c_ptr) :: elements = c_null_ptr
        type(c_ptr) :: shapes = c_null_ptr
    end type nestgrid_probed

    interface
        integer(c_int) function nestgrid_prerolls_make(out, message, message_size) &
                bind(c, name="nestgrid_prerolls_make")
            import
            type(c_ptr), intent(out) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_prerolls_make

        subroutine nestgrid_prerolls_free(prerolls) bind(c, name="nestgrid_prerolls_free")
            import
            type(c_ptr), value :: prerolls
        end subroutine nestgrid_prerolls_free

        integer(c_int) function nestgrid_isosurface(grid, field, isovalue, threshold, &
                out, message, message_size) bind(c, name="nestgrid_isosurface")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            real(c_double), value :: isovalue
            real(c_double), value :: threshold
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_isosurface

        integer(c_int) function nestgrid_isosurface_with(grid, field, isovalue, options, &
                out, message, message_size) bind(c, name="nestgrid_isosurface_with")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            real(c_double), value :: isovalue
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_isosurface_with

        integer(c_int) function nestgrid_isosurfaces(grid, field, count, isovalues, options, &
                out, message, message_size) bind(c, name="nestgrid_isosurfaces")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            integer(c_size_t), value :: count
            real(c_double), intent(in) :: isovalues(*)
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out(*)
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_isosurfaces

        integer(c_int) function nestgrid_isoband(grid, field, low, high, options, &
                out, message, message_size) bind(c, name="nestgrid_isoband")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            real(c_double), value :: low
            real(c_double), value :: high
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_isoband

        integer(c_int) function nestgrid_height_field(grid, field, scale, options, &
                out, message, message_size) bind(c, name="nestgrid_height_field")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            real(c_double), value :: scale
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_height_field

        integer(c_int) function nestgrid_measure(grid, field, surface, isovalue, points, &
                options, out, message, message_size) bind(c, name="nestgrid_measure")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            type(nestgrid_surface), intent(in) :: surface
            real(c_double), value :: isovalue
            integer(c_int64_t), value :: points
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_measured), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_measure

        integer(c_int) function nestgrid_details(surface, out, message, message_size) &
            bind(c, name="nestgrid_details")
            import
            type(nestgrid_surface), intent(in) :: surface
            type(nestgrid_surface_details), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_details

        integer(c_int) function nestgrid_join(piece, out, message, message_size) &
            bind(c, name="nestgrid_join")
            import
            type(nestgrid_surface), intent(in) :: piece
            type(nestgrid_joined), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_join

        subroutine nestgrid_joined_free(joined) bind(c, name="nestgrid_joined_free")
            import
            type(nestgrid_joined), intent(inout) :: joined
        end subroutine nestgrid_joined_free

        integer(c_int) function nestgrid_measure_surface(surface, flux_from, out, message, &
                message_size) bind(c, name="nestgrid_measure_surface")
            import
            type(nestgrid_surface), intent(in) :: surface
            integer(c_int), value :: flux_from
            type(nestgrid_surface_measures), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_measure_surface

        subroutine nestgrid_surface_measures_free(measures) &
            bind(c, name="nestgrid_surface_measures_free")
            import
            type(nestgrid_surface_measures), intent(inout) :: measures
        end subroutine nestgrid_surface_measures_free

        subroutine nestgrid_surface_free(surface) bind(c, name="nestgrid_surface_free")
            import
            type(nestgrid_surface), intent(inout) :: surface
        end subroutine nestgrid_surface_free

        integer(c_int) function nestgrid_check_grid(grid, field, message, message_size) &
            bind(c, name="nestgrid_check_grid")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_check_grid

        integer(c_int) function nestgrid_slice(grid, field, through, normal, options, &
                out, message, message_size) bind(c, name="nestgrid_slice")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            real(c_double), intent(in) :: through(3)
            real(c_double), intent(in) :: normal(3)
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_slice

        integer(c_int) function nestgrid_slice_along(grid, field, function, options, &
                out, message, message_size) bind(c, name="nestgrid_slice_along")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            type(nestgrid_level_function), intent(in) :: function
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_slice_along

        integer(c_int) function nestgrid_boundary_surface(grid, field, options, &
                out, message, message_size) bind(c, name="nestgrid_boundary_surface")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_boundary_surface

        integer(c_int) function nestgrid_discontinuous_height_field(grid, data, scale, options, &
                out, message, message_size) bind(c, name="nestgrid_discontinuous_height_field")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_leaf_data), intent(in) :: data
            real(c_double), value :: scale
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_discontinuous_height_field

        integer(c_int) function nestgrid_discontinuous_slice(grid, data, through, normal, options, &
                out, message, message_size) bind(c, name="nestgrid_discontinuous_slice")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_leaf_data), intent(in) :: data
            real(c_double), intent(in) :: through(3)
            real(c_double), intent(in) :: normal(3)
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_discontinuous_slice

        integer(c_int) function nestgrid_discontinuous_slice_along(grid, data, function, options, &
                out, message, message_size) bind(c, name="nestgrid_discontinuous_slice_along")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_leaf_data), intent(in) :: data
            type(nestgrid_level_function), intent(in) :: function
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_surface), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_discontinuous_slice_along

        integer(c_int) function nestgrid_isolines(grid, field, values, count, options, &
                out, message, message_size) bind(c, name="nestgrid_isolines")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            real(c_double), intent(in) :: values(*)
            integer(c_size_t), value :: count
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_lines), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_isolines

        integer(c_int) function nestgrid_surface_isolines(surface, attribute, values, count, &
                out, message, message_size) bind(c, name="nestgrid_surface_isolines")
            import
            type(nestgrid_surface), intent(in) :: surface
            integer(c_size_t), value :: attribute
            real(c_double), intent(in) :: values(*)
            integer(c_size_t), value :: count
            type(nestgrid_lines), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_surface_isolines

        subroutine nestgrid_lines_free(lines) bind(c, name="nestgrid_lines_free")
            import
            type(nestgrid_lines), intent(inout) :: lines
        end subroutine nestgrid_lines_free

        integer(c_int) function nestgrid_probe(grid, field, points, count, options, &
                out, message, message_size) bind(c, name="nestgrid_probe")
            import
            type(nestgrid_grid), intent(in) :: grid
            type(nestgrid_field), intent(in) :: field
            real(c_double), intent(in) :: points(*)
            integer(c_size_t), value :: count
            type(nestgrid_options), intent(in), optional :: options
            type(nestgrid_probed), intent(inout) :: out
            character(kind=c_char), intent(inout) :: message(*)
            integer(c_size_t), value :: message_size
        end function nestgrid_probe

        subroutine nestgrid_probed_free(probed) bind(c, name="nestgrid_probed_free")
            import
            type(nestgrid_probed), intent(inout) :: probed
        end subroutine nestgrid_probed_free
    end interface
end module nestgrid
