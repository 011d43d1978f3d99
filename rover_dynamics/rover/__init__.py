"""The thesis' Mars rover: 23 bodies with the ground, 21 hinges, six wheels; a description a user can edit."""
