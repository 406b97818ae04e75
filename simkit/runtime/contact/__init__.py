"""Forces between bodies in contact: contact law, friction, slip, moving surfaces, speculative contacts."""
