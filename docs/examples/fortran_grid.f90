! SPDX-FileCopyrightText: the nestgrid authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A grid in Fortran: a square, halved in both directions again and again where a circle passes, so
! that hanging nodes occur. Cells are numbered in their solver's arrays; an element is the number.
module cells
    use, intrinsic :: iso_c_binding
    use nestgrid
    implicit none

    integer, parameter :: most_cells = 20000, levels = 7
    real(c_double), parameter :: radius = 0.3d0

    ! [solver]
    integer :: cell_count = 1
    real(c_double) :: low(2, most_cells), width(most_cells)
    integer :: first_child(most_cells) = 0   ! of four in a row; 0 where the cell is not divided
    ! [solver]

    ! The corners of a cell, x fastest, are 0 to 3. New nodes are the middles of the edges in x at
    ! the bottom and at the top, of those in y, and of the cell.
    type(nestgrid_stencil), target :: middles(5) = [ &
        nestgrid_stencil(2, [0, 1, 0, 0, 0, 0, 0, 0], [0.5d0, 0.5d0, 0d0, 0d0, 0d0, 0d0, 0d0, 0d0], 0), &
        nestgrid_stencil(2, [2, 3, 0, 0, 0, 0, 0, 0], [0.5d0, 0.5d0, 0d0, 0d0, 0d0, 0d0, 0d0, 0d0], 0), &
        nestgrid_stencil(2, [0, 2, 0, 0, 0, 0, 0, 0], [0.5d0, 0.5d0, 0d0, 0d0, 0d0, 0d0, 0d0, 0d0], 0), &
        nestgrid_stencil(2, [1, 3, 0, 0, 0, 0, 0, 0], [0.5d0, 0.5d0, 0d0, 0d0, 0d0, 0d0, 0d0, 0d0], 0), &
        nestgrid_stencil(4, [0, 1, 2, 3, 0, 0, 0, 0], &
                         [0.25d0, 0.25d0, 0.25d0, 0.25d0, 0d0, 0d0, 0d0, 0d0], 0)]
    real(c_double), parameter :: middle_at(2, 5) = &
        reshape([0.5d0, 0d0, 0.5d0, 1d0, 0d0, 0.5d0, 1d0, 0.5d0, 0.5d0, 0.5d0], [2, 5])
    type(nestgrid_child), target :: quarters(4) = [ &
        nestgrid_child(NESTGRID_QUADRILATERAL, [0, 4, 6, 8, 0, 0, 0, 0], 1), &
        nestgrid_child(NESTGRID_QUADRILATERAL, [4, 1, 8, 7, 0, 0, 0, 0], 1), &
        nestgrid_child(NESTGRID_QUADRILATERAL, [6, 8, 2, 5, 0, 0, 0, 0], 1), &
        nestgrid_child(NESTGRID_QUADRILATERAL, [8, 7, 5, 3, 0, 0, 0, 0], 1)]
    character(kind=c_char), target :: rule_name(8) = ['q', 'u', 'a', 'r', 't', 'e', 'r', c_null_char]
    type(nestgrid_rule), target :: rule

contains

    subroutine solve
        integer :: cell, c
        low(:, 1) = 0
        width(1) = 1
        cell = 1
        do while (cell <= cell_count)
            if (width(cell) > 0.5d0**levels .and. &
                abs(circle(low(:, cell) + width(cell) / 2) - radius) < 1.5d0 * width(cell)) then
                first_child(cell) = cell_count + 1
                do c = 0, 3
                    width(cell_count + 1) = width(cell) / 2
                    low(:, cell_count + 1) = low(:, cell) + width(cell) / 2 * [mod(c, 2), c / 2]
                    cell_count = cell_count + 1
                end do
            end if
            cell = cell + 1
        end do
    end subroutine solve

    real(c_double) function circle(x)
        real(c_double), intent(in) :: x(2)
        circle = hypot(x(1) - 0.4d0, x(2) - 0.55d0)
    end function circle

    ! [grid]
    integer(c_int) function coarse_count(self, count) bind(c)
        type(c_ptr), value :: self
        integer(c_size_t), intent(out) :: count
        count = 1
        coarse_count = 0
    end function coarse_count

    integer(c_int) function coarse(self, context, i, out) bind(c)
        type(c_ptr), value :: self, context
        integer(c_size_t), value :: i
        type(nestgrid_coarse), intent(out) :: out
        integer :: k
        out%element%word(1) = 1   ! the number of the cell
        out%shape = NESTGRID_QUADRILATERAL
        out%orientation = 1
        do k = 0, 3
            out%corners(1:2, k + 1) = low(:, 1) + width(1) * [mod(k, 2), k / 2]
            out%ids(k + 1) = k
        end do
        coarse = 0
    end function coarse

    integer(c_int) function split(self, context, e, rule_number) bind(c)
        type(c_ptr), value :: self, context
        type(nestgrid_element), intent(in) :: e
        integer(c_int), intent(out) :: rule_number
        rule_number = merge(-1, 0, first_child(e%word(1)) == 0)
        split = 0
    end function split

    integer(c_int) function children(self, context, e, count, out) bind(c)
        type(c_ptr), value :: self, context
        type(nestgrid_element), intent(in) :: e
        integer(c_size_t), value :: count
        type(nestgrid_element), intent(out) :: out(count)
        integer :: c
        do c = 1, int(count)
            out(c)%word(1) = first_child(e%word(1)) + c - 1
        end do
        children = 0
    end function children
    ! [grid]

    ! [field]
    integer(c_int) function coarse_values(self, context, i, count, out, missing) bind(c)
        type(c_ptr), value :: self, context
        integer(c_size_t), value :: i, count
        real(c_double), intent(out) :: out(count)
        integer(c_int64_t), intent(out) :: missing
        integer :: k
        do k = 0, int(count) - 1
            out(k + 1) = circle(low(:, 1) + width(1) * [mod(k, 2), k / 2])
        end do
        missing = 0
        coarse_values = 0
    end function coarse_values

    integer(c_int) function new_values(self, context, e, which, count, out, missing) bind(c)
        type(c_ptr), value :: self, context
        type(nestgrid_element), intent(in) :: e
        integer(c_int64_t), value :: which
        integer(c_size_t), value :: count
        real(c_double), intent(inout) :: out(count)
        integer(c_int64_t), intent(out) :: missing
        integer :: n
        do n = 0, int(count) - 1
            if (btest(which, n)) then
                out(n + 1) = circle(low(:, e%word(1)) + width(e%word(1)) * middle_at(:, n + 1))
            end if
        end do
        missing = 0
        new_values = 0
    end function new_values
    ! [field]

end module cells

program fortran_grid
    use, intrinsic :: iso_c_binding
    use nestgrid
    use cells
    implicit none

    type(nestgrid_grid) :: grid
    type(nestgrid_field) :: field
    real(c_double), parameter :: exact = 2 * acos(-1d0) * radius
    character(len=300) :: message

    call solve
    ! [use]
    rule = nestgrid_rule(c_loc(rule_name), NESTGRID_QUADRILATERAL, 5, c_loc(middles), 4, c_loc(quarters))
    grid%size = c_sizeof(grid)
    grid%dimension = 2
    grid%rule_count = 1
    grid%rules = c_loc(rule)
    grid%coarse_count = c_funloc(coarse_count)
    grid%coarse = c_funloc(coarse)
    grid%split = c_funloc(split)
    grid%children = c_funloc(children)

    field%size = c_sizeof(field)
    field%value_type = NESTGRID_DOUBLE
    field%components = 1
    field%coarse_values = c_funloc(coarse_values)
    field%new_values = c_funloc(new_values)

    call require(nestgrid_check_grid(grid, field, message, len(message, c_size_t)))
    ! [use]
    call draw_isoline
    call probe_centre

contains

    subroutine draw_isoline
        ! [isoline]
        type(nestgrid_options) :: options
        type(nestgrid_lines) :: lines
        real(c_double), pointer :: x(:, :)
        integer(c_int32_t), pointer :: points(:)
        integer(c_size_t), pointer :: first(:)
        real(c_double) :: length
        integer :: line, i

        options%size = c_sizeof(options)
        options%error = 1d-4   ! the data differ from the line by at most this
        options%threads = 2
        lines%size = c_sizeof(lines)
        call require(nestgrid_isolines(grid, field, [radius], 1_c_size_t, options, lines, &
                                       message, len(message, c_size_t)))
        call c_f_pointer(lines%vertices, x, [3_c_size_t, lines%vertex_count])
        call c_f_pointer(lines%first, first, [lines%line_count + 1])
        call c_f_pointer(lines%points, points, [first(lines%line_count + 1)])
        length = 0
        do line = 1, int(lines%line_count)
            do i = int(first(line)) + 1, int(first(line + 1)) - 1   ! points count from 0
                length = length + norm2(x(:, points(i + 1) + 1) - x(:, points(i) + 1))
            end do
        end do
        print '(i0, a, f8.6, a, f8.6)', lines%line_count, ' line, length ', length, ', exact ', exact
        if (lines%line_count /= 1 .or. abs(length - exact) > 1d-3) error stop 'the line is wrong'
        call nestgrid_lines_free(lines)
        ! [isoline]
    end subroutine draw_isoline

    subroutine probe_centre
        type(nestgrid_probed) :: probed
        real(c_double), pointer :: values(:)
        probed%size = c_sizeof(probed)
        call require(nestgrid_probe(grid, field, [0.4d0, 0.85d0, 0d0], 1_c_size_t, out=probed, &
                                    message=message, message_size=len(message, c_size_t)))
        call c_f_pointer(probed%values, values, [probed%point_count])
        print '(a, f8.6)', 'on the circle the field is ', values(1)
        if (abs(values(1) - radius) > 1d-3) error stop 'the value is wrong'
        call nestgrid_probed_free(probed)
    end subroutine probe_centre

    subroutine require(code)
        integer(c_int), intent(in) :: code
        if (code == 0) return
        print '(a)', message(:index(message, c_null_char) - 1)
        error stop 1
    end subroutine require

end program fortran_grid
