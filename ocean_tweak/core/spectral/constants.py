# SPDX-License-Identifier: GPL-3.0-or-later
"""Physical and empirical constants, each with its unit and its source."""

# Water, Horvath (2015), table 1
GRAVITY = 9.81  # m/s²
WATER_DENSITY = 1000.0  # kg/m³
SURFACE_TENSION = 0.074  # N/m

# Pierson & Moskowitz (1964), after Horvath (2015), eq. 18 and 19
PM_ALPHA = 8.1e-3
PM_BETA = 0.74
PM_WIND_FACTOR = 1.026  # wind at 19.5 m over wind at 10 m
PM_PEAK = 0.855  # ω_p U / g of a fully developed sea, U at 10 m

# JONSWAP, Hasselmann et al. (1973), after Horvath (2015), eq. 28
JONSWAP_ALPHA = 0.076  # α at g F / U² = 1
JONSWAP_ALPHA_EXPONENT = 0.22
JONSWAP_PEAK = 22.0  # ω_p U / g at g F / U² = 1
JONSWAP_SIGMA_BELOW = 0.07  # relative peak width at and below the peak frequency
JONSWAP_SIGMA_ABOVE = 0.09  # and above it
PEAK_ENHANCEMENT = 3.3  # γ, the mean of the JONSWAP measurements
DEVELOPMENT = 1.25  # factor in exp(-5/4 (ω_p/ω)⁴), which places the peak at ω_p

# Wind over height, Horvath (2015), § 5.1.3, corrected to 10⁻³ and the log law's 1/κ
DRAG_OFFSET = 0.8e-3
DRAG_SLOPE = 0.065e-3  # s/m
KARMAN = 0.4

# Mitsuyasu (1975), after Horvath (2015), eq. 35 and 36
MITSUYASU_PEAK = 11.5
MITSUYASU_WIND_EXPONENT = -2.5
MITSUYASU_BELOW_EXPONENT = 5.0
MITSUYASU_ABOVE_EXPONENT = -2.5

# Hasselmann, Dunckel & Ewing (1980), after Horvath (2015), eq. 37
HASSELMANN_BELOW = 6.97
HASSELMANN_BELOW_EXPONENT = 4.06
HASSELMANN_ABOVE = 9.77
HASSELMANN_ABOVE_EXPONENT = -2.33
HASSELMANN_WIND_FACTOR = -1.45
HASSELMANN_WIND_OFFSET = 1.17  # U ω_p / g
HASSELMANN_ABOVE_FROM = 1.05  # ω/ω_p

# Donelan, Hamilton & Hui (1985) with Banner's high-frequency part, after Horvath (2015), eq. 38
DONELAN_BELOW = 2.61
DONELAN_MIDDLE = 2.28
DONELAN_EXPONENT = 1.3
DONELAN_MIDDLE_FROM = 0.95  # ω/ω_p
BANNER_FROM = 1.6  # ω/ω_p
BANNER_OFFSET = -0.4
BANNER_FACTOR = 0.8393
BANNER_EXPONENT = -0.567

# Swell, Horvath (2015), eq. 45
SWELL_SHAPE = 16.0

# Trough damping: the long waves are those below this multiple of the peak wave number
TROUGH_FILTER = 3.0

# Ratio of height to length at which waves break in deep water, Miche (1944)
BREAKING_STEEPNESS = 0.142

# Wind in m/s, or fetch in m, at or below which there are no waves: they would be smaller than an atom
CALM = 1e-12

# Whitecap coverage, Monahan & O'Muircheartaigh (1980): fraction of the sea, wind at 10 m in m/s
WHITECAP_FACTOR = 3.84e-6
WHITECAP_EXPONENT = 3.41

# Whitecap coverage, Callaghan, de Leeuw, Cohen & O'Dowd (2008): fraction of the sea, wind at 10 m in m/s
CALLAGHAN_LEAST = 3.70
CALLAGHAN_SLOW_FACTOR = 3.18e-5
CALLAGHAN_FAST_FROM = 10.18
CALLAGHAN_FAST_FACTOR = 4.82e-6
CALLAGHAN_FAST_OFFSET = 1.98

# Modified Pierson-Moskowitz filter, Mastin, Watterberg & Mareda (1987), eq. 2 and 5
MASTIN_PEAK = 0.13  # f_m U / g, U at 10 m
MASTIN_SHAPE = 9.77
MASTIN_BELOW_EXPONENT = 4.06
MASTIN_ABOVE_EXPONENT = -2.34
DOMINANT_SHARE = (
    0.6666666666666666  # fraction of the peak's energy above which waves belong to the dominant band
)
