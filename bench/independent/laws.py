"""What time, contact and sensor make of a linear body's forces: each takes and gives (n, 3) [N]."""
import numpy as np

from bodies import rotation


def remembered(f, t, tau):
    """h with dh/dt = df/dt - h/tau, exact for forces straight between the samples."""
    h = np.zeros_like(f)
    for i in range(1, len(t)):
        dt = t[i] - t[i - 1]
        fade = np.exp(-dt / tau)
        h[i] = fade * h[i - 1] + (f[i] - f[i - 1]) / dt * tau * (1 - fade)
    return h


def relaxing(terms):
    """E(t) = E0 (1 - sum g (1 - exp(-t/tau))), Poisson's ratio constant; terms: (g, tau)."""
    left = 1 - sum(g for g, _ in terms)
    return lambda f, press: left * f + sum(g * remembered(f, press.t, tau) for g, tau in terms)


def velocity(x, t):
    """Of the way since the last sample; at rest before the first."""
    return np.vstack([np.zeros((1, 3)), np.diff(x, axis=0) / np.diff(t)[:, None]])


def dashpot(c):
    """The same in every direction [N s/m]."""
    return lambda f, press: f - c * velocity(press.u, press.t)


def viscous_body(tau):
    """Kelvin-Voigt: stress C (strain + tau d strain/dt)."""
    return lambda f, press: f + tau * velocity(f, press.t)


def low_pass(tau):
    return lambda f, press: f - remembered(f, press.t, tau)


def delay(d):
    def law(f, press):
        return np.array([np.interp(press.t - d, press.t, c) for c in f.T]).T

    return law


def offset(b, rate=(0, 0, 0)):
    return lambda f, press: f + np.array(b) + np.outer(press.t, rate)


def warm(beta):
    """Stiffness lost per kelvin above 22 degC, linearly; the press carries its true temperature."""
    return lambda f, press: f * (1 - beta * (press.temperature - 22))[:, None]


def aged(rate):
    """Stiffness lost per second of the session."""
    return lambda f, press: f * (1 - rate * press.t)[:, None]


def askew(vector):
    return lambda f, press: f @ rotation(vector).T


def gains(g):
    return lambda f, press: f * np.array(g)


def slipping(mu):
    """Coulomb: what is more than mu times the pressing force slips away."""

    def law(f, press):
        normal = f @ press.n
        side = f - np.outer(normal, press.n)
        size = np.linalg.norm(side, axis=1)
        share = np.minimum(1, mu * np.maximum(0, normal) / np.maximum(size, 1e-12))
        return np.outer(normal, press.n) + share[:, None] * side

    return law


def worn(most):
    """Softer by every earlier press of the place, towards 1 - most."""
    return lambda f, press: f * (1 - most * (1 - np.exp(-press.repeat)))


def mullins(most):
    """Softer up to the depth reached before."""

    def law(f, press):
        depth = -press.u @ press.n
        return f * np.where(depth < press.deepest, 1 - most, 1)[:, None] if press.repeat else f

    return law


def saturating(full):
    """A sensor whose axes give full tanh(f / full)."""
    return lambda f, press: full * np.tanh(f / full)


def dead(band):
    """Nothing below the band, true above it."""
    return lambda f, press: np.where(np.abs(f) < band, 0, f)


def tares(size, seed):
    random = np.random.default_rng(seed)
    offsets = {}

    def law(f, press):
        return f + offsets.setdefault(press.t[0], random.normal(0, size, 3))

    return law
