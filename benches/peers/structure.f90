! A structure with a smoothed stop, for AUTO-07p: M x'' + C x' + K x + e_s k width log(1 + exp(g / width)) = e_d drive cos(w t), with g = x_s - gap.
!
! structure.dat has, line by line, what `structures` reads; matrices are multiplied by M^-1 there. The excitation is the cosine of an oscillator that
! settles on a circle: s' = s + w c - s (s^2 + c^2), c' = c - w s - c (s^2 + c^2). PAR(1) is w, PAR(11) the period.

module structures
  implicit none
  integer :: n = 0, at
  double precision :: spring, gap, width
  double precision, allocatable :: stiffness(:, :), damping(:, :), push(:), load(:), cosine(:), sine(:)
contains
  subroutine read_once()
    if (n > 0) return
    open (77, file='structure.dat', status='old')
    read (77, *) n, at, spring, gap, width
    allocate (stiffness(n, n), damping(n, n), push(n), load(n), cosine(n), sine(n))
    read (77, *) stiffness, damping, push, load, cosine, sine
    close (77)
  end subroutine
end module

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use structures
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(in out) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: s, c, w, g, bend, force, slope
  integer :: i
  call read_once()
  s = u(2*n + 1)
  c = u(2*n + 2)
  w = par(1)
  g = u(at) - gap
  bend = exp(-abs(g)/width)
  f(1:n) = u(n + 1:2*n)
  force = spring*(max(g, 0d0) + width*log(1 + bend))
  f(n + 1:2*n) = load*c - matmul(stiffness, u(1:n)) - matmul(damping, u(n + 1:2*n)) - push*force
  f(2*n + 1) = s + w*c - s*(s**2 + c**2)
  f(2*n + 2) = c - w*s - c*(s**2 + c**2)
  if (ijac == 0) return
  slope = spring*merge(1d0, bend, g > 0)/(1 + bend)
  dfdu = 0
  do i = 1, n
    dfdu(i, n + i) = 1
  end do
  dfdu(n + 1:2*n, 1:n) = -stiffness
  dfdu(n + 1:2*n, n + 1:2*n) = -damping
  dfdu(n + 1:2*n, at) = dfdu(n + 1:2*n, at) - push*slope
  dfdu(n + 1:2*n, 2*n + 2) = load
  dfdu(2*n + 1, 2*n + 1) = 1 - 3*s**2 - c**2
  dfdu(2*n + 1, 2*n + 2) = w - 2*s*c
  dfdu(2*n + 2, 2*n + 1) = -w - 2*s*c
  dfdu(2*n + 2, 2*n + 2) = 1 - s**2 - 3*c**2
  if (ijac == 1) return
  dfdp(1:2*n, 1) = 0
  dfdp(2*n + 1, 1) = c
  dfdp(2*n + 2, 1) = -s
end subroutine

! The motion without contact: x = cosine cos(w t) - sine sin(w t).
subroutine stpnt(ndim, u, par, t)
  use structures
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in out) :: u(ndim), par(*)
  double precision, intent(in) :: t
  double precision, parameter :: turn = 6.283185307179586477d0
  double precision :: start
  integer :: unit
  call read_once()
  open (newunit=unit, file='start.dat', status='old')
  read (unit, *) start
  close (unit)
  par(1) = start
  par(11) = turn/start
  u(1:n) = cosine*cos(turn*t) - sine*sin(turn*t)
  u(n + 1:2*n) = -start*(cosine*sin(turn*t) + sine*cos(turn*t))
  u(2*n + 1) = sin(turn*t)
  u(2*n + 2) = cos(turn*t)
end subroutine

subroutine bcnd()
end subroutine

subroutine icnd()
end subroutine

subroutine fopt()
end subroutine

subroutine pvls()
end subroutine
